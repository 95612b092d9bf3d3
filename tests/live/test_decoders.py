"""Decoders: cut anywhere they give the same, of garbage they make nothing, and what they skipped they say."""

from __future__ import annotations

import json
import os
import random
import struct
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ulna.live.decode.binary import CHECKSUMS, Packets
from ulna.live.decode.decoder import Decoder, Row, TooLong
from ulna.live.decode.fields import Fields
from ulna.live.decode.json_values import JsonValues
from ulna.live.faults import GARBAGE

FUZZED = int(os.environ.get("ULNA_LIVE_FUZZED", "100000"))
"""Bytes a decoder; 1000000 in a long run."""

NAMES = ("n", "a", "b", "c")


def _fields() -> Decoder:
    return Fields(",", "POS", ("ms", "a", "b", "push"), time="ms", button="push")


def _plain() -> Decoder:
    return Fields()


def _json() -> Decoder:
    return JsonValues(["msg.position"], "msg.name", ("a", "b"), "msg.header.stamp")


def _loose() -> Decoder:
    return JsonValues(["q"], "names", None, "t", "s", "button", loose=True)


def _summed() -> Decoder:
    return Packets("<I3f", b"\xaa\x55", "crc16-modbus", NAMES, time="n")


def _synced() -> Decoder:
    return Packets("<I3f", b"\xaa\x55", None, NAMES, time="n")


def _line_fields(k: int) -> bytes:
    return f"POS,{k},{k * 0.5},{-k / 3!r},{k % 2}\r\n".encode()


def _line_plain(k: int) -> bytes:
    return f"{k} \t{k / 7!r};{-k:.3e}\n".encode()


def _line_json(k: int) -> bytes:
    stamp = {"sec": k, "nanosec": 500_000_000}
    names, values = ["a", "b"], [k / 7, -k]
    if k % 2:
        names, values = names[::-1], values[::-1]
    return json.dumps({"msg": {"header": {"stamp": stamp}, "name": names, "position": values}}).encode() + b"\n"


def _line_loose(k: int) -> bytes:
    return json.dumps({"q": [k / 7, -k], "t": k / 10, "button": bool(k % 2)}).encode() + b"\n"


def _packet(k: int) -> bytes:
    return struct.pack("<I3f", k, k / 2, -k / 4, k / 8)


def _packet_summed(k: int) -> bytes:
    return b"\xaa\x55" + _packet(k) + struct.pack("<H", CHECKSUMS["crc16-modbus"][1](_packet(k)))


def _packet_synced(k: int) -> bytes:
    return b"\xaa\x55" + _packet(k)


CASES: dict[str, tuple[Callable[[], Decoder], Callable[[int], bytes], Callable[[int], tuple[Any, ...]]]] = {
    "fields": (_fields, _line_fields, lambda k: (k * 1e-3, (k * 0.5, -k / 3), k % 2 == 1)),
    "plain": (_plain, _line_plain, lambda k: (None, (float(k), k / 7, float(f"{-k:.3e}")), None)),
    "json": (_json, _line_json, lambda k: (k + 0.5, (k / 7, float(-k)), None)),
    "loose": (_loose, _line_loose, lambda k: (k / 10, (k / 7, float(-k)), k % 2 == 1)),
    "summed": (_summed, _packet_summed, lambda k: (k * 1e-3, (k / 2, -k / 4, k / 8), None)),
    "synced": (_synced, _packet_synced, lambda k: (k * 1e-3, (k / 2, -k / 4, k / 8), None)),
}


def fed(decoder: Decoder, data: bytes, cuts: list[int]) -> list[Row]:
    """All rows of a stream that comes in pieces."""
    ends = [*sorted(cuts), len(data)]
    begin, rows = 0, []
    for end in ends:
        rows += decoder.feed(data[begin:end], 0.0)
        begin = end
    return rows


def said(rows: list[Row]) -> list[tuple[Any, ...]]:
    return [(row.t_device_s, row.values, row.button) for row in rows]


def near(found: list[tuple[Any, ...]], expected: list[tuple[Any, ...]]) -> None:
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        assert one[0] == (None if other[0] is None else pytest.approx(other[0]))
        assert one[1] == other[1]
        assert one[2] == other[2]


@pytest.mark.parametrize("case", CASES)
@given(data=st.data())
def test_cut_anywhere_it_is_the_same(case: str, data: st.DataObject) -> None:
    made, line, expected = CASES[case]
    stream = b"".join(line(k) for k in range(1, 9))
    cuts = data.draw(st.lists(st.integers(0, len(stream)), max_size=20))
    found = said(fed(made(), stream, cuts))
    near(found, [expected(k) for k in range(1, 9)])


@pytest.mark.parametrize("case", CASES)
def test_every_single_cut(case: str) -> None:
    made, line, expected = CASES[case]
    stream = b"".join(line(k) for k in range(1, 4))
    for cut in range(len(stream) + 1):
        near(said(fed(made(), stream, [cut])), [expected(k) for k in range(1, 4)])


@pytest.mark.parametrize("case", CASES)
def test_garbage_between_is_skipped_counted_and_said_once(case: str) -> None:
    made, line, expected = CASES[case]
    decoder = made()
    garbage = b"\xfe\x01 rubbish \xff\n"
    stream = line(1) + line(2) + garbage + line(3) + line(4)
    near(said(fed(decoder, stream, list(range(0, len(stream), 3)))), [expected(k) for k in (1, 2, 3, 4)])
    faults = decoder.skipped.taken()
    assert [fault.kind for fault in faults] == [GARBAGE]
    assert decoder.skipped.bytes in (len(garbage), len(garbage) - 1)  # a line's end belongs to no line
    assert str(decoder.skipped.bytes) in faults[0].text
    assert decoder.skipped.taken() == []


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("case", CASES)
def test_random_bytes_never_raise_and_are_counted(case: str, whole: bool) -> None:
    made, line, _ = CASES[case]
    decoder = made()
    source = random.Random(f"{case} {whole}")
    fed_bytes = 0
    while fed_bytes < FUZZED:
        piece = source.randbytes(source.choice([1, 2, 7, 64, 300]))
        way = source.random()
        if way < 0.2:  # near a reading: spoilt in one place
            piece = bytearray(line(source.randrange(1000)))
            piece[source.randrange(len(piece))] = source.randrange(256)
        elif way < 0.4:
            piece = bytes(source.choice(b'0123456789,.;-+eE "{}[]:\r\nqPOS') for _ in range(source.randrange(1, 60)))
        fed_bytes += len(piece)
        try:
            rows = decoder.feed(bytes(piece), 1.0, whole)
        except TooLong:
            decoder = made()  # the source would have ended, with a sentence
            continue
        assert all(len(row.values) == len(decoder.channels or ()) for row in rows)
        for fault in decoder.skipped.taken():
            assert fault.kind == GARBAGE
            assert fault.text.isprintable()
    assert decoder.skipped.bytes > 0


def test_opened_in_the_midst_of_a_line_its_rest_is_not_read() -> None:
    decoder = Fields(midway=True)
    assert said(fed(decoder, b"34.5,2\n1.5,3\n", [1, 4])) == [(None, (1.5, 3.0), None)]
    (fault,) = decoder.skipped.taken()
    assert "had begun before" in fault.text


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"1," * 3000, "more than 4096 bytes"),
        (b",".join([b"1"] * 33) + b"\n", "33 fields"),
    ],
)
def test_what_is_too_long_ends_it(data: bytes, words: str) -> None:
    with pytest.raises(TooLong, match=words):
        fed(Fields(), data, list(range(0, len(data), 100)))


def test_too_many_numbers_in_a_message_end_it() -> None:
    with pytest.raises(TooLong, match="33 numbers"):
        JsonValues(["q"]).feed(json.dumps({"q": [1.0] * 33}).encode(), 0.0, whole=True)


def test_numbers_that_are_none() -> None:
    decoder = Fields(names=("a", "b"))
    assert fed(decoder, b"nan,1\ninf,1\n1_0,1\n0x1,1\n1e999,1\n,1\n", []) == []
    assert decoder.skipped.runs == 1


def test_checksums_are_those_of_the_literature() -> None:
    """Check values of the CRC catalogue, of the text 123456789."""
    assert CHECKSUMS["crc16-modbus"][1](b"123456789") == 0x4B37
    assert CHECKSUMS["crc16-ccitt"][1](b"123456789") == 0x29B1
    assert CHECKSUMS["sum8"][1](b"123456789") == sum(b"123456789") % 256
    assert CHECKSUMS["xor8"][1](b"123456789") == 0x31


def test_a_wrong_checksum_is_no_reading() -> None:
    spoilt = bytearray(_packet_summed(2))
    spoilt[5] ^= 1
    decoder = _summed()
    assert [row.t_device_s for row in fed(decoder, _packet_summed(1) + spoilt + _packet_summed(3), [])] == [
        0.001,
        0.003,
    ]
    assert decoder.skipped.bytes == len(spoilt)


def test_sync_bytes_within_numbers_do_not_mislead_for_long() -> None:
    inside = struct.unpack("<f", b"\xaa\x55\xaa\x55")[0]
    values = [inside if k % 3 == 0 else float(k) for k in range(50)]
    packets = b"".join(b"\xaa\x55" + struct.pack("<I3f", k, *[value] * 3) for k, value in enumerate(values))
    rows = fed(_synced(), packets[9:], [])  # begins in the midst of a packet that has such bytes
    assert [row.values for row in rows[-47:]] == [(value,) * 3 for value in values[-47:]]


def test_names_of_the_first_message_are_the_order() -> None:
    decoder = JsonValues(["position"], "name")
    messages = [{"name": ["b", "a"], "position": [2, 1]}, {"name": ["a", "b", "c"], "position": [3, 4, 5]}]
    rows = [row for each in messages for row in decoder.feed(json.dumps(each).encode(), 0.0, whole=True)]
    assert (decoder.channels, [row.values for row in rows]) == (("b", "a"), [(2.0, 1.0), (4.0, 3.0)])
    assert decoder.feed(b'{"name": ["a"], "position": [3]}', 0.0, whole=True) == []
