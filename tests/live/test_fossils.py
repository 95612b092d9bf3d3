"""One sample of each released format, never changed again."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ulna.live.decode.binary import Packets
from ulna.live.decode.json_values import JsonValues
from ulna.live.journal import EVENT, HEAD, SAMPLES, TOUCH, WITHDRAWAL, Reading
from ulna.live.samples import Hello
from ulna.live.source import SourceEnded
from ulna.live.source_file import load_source
from ulna.live.stream import Frames, streaming
from ulna.live.tables import DecodeTable

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"


def all_of(path: Path | str) -> tuple[list[Frames], list[str]]:
    frames, kinds = [], []
    with streaming(path) as stream:
        while True:
            try:
                frames.append(stream.read(1.0))
            except SourceEnded:
                return frames, kinds + [fault.kind for fault in stream.source.faults()]
            kinds += [fault.kind for fault in frames[-1].faults]


def test_source_1() -> None:
    file = load_source(FOSSILS / "source-1.toml").file
    assert (file.limits.speed, file.limits.gap) == (12.5, 0.2)
    assert (file.still.seconds, file.still.spread, file.still.drift, file.still.rearm) == (0.4, 0.02, 0.01, 3.0)
    assert file.trigger.by == "button"
    frames, kinds = all_of(FOSSILS / "source-1.toml")
    samples = [each.samples for each in frames if len(each.samples)]
    raw = np.concatenate([each.raw for each in samples])
    q = np.concatenate([each.q_rad for each in frames])
    k = np.arange(12)
    np.testing.assert_array_equal(raw[:, 0], 1000 + 7 * k)
    np.testing.assert_allclose(q, 2 * math.pi * np.stack([(4090 + k) / 4096, (1000 + 7 * k) / 163840], axis=1))
    assert samples[0].t_device_s is not None
    np.testing.assert_allclose(samples[0].t_device_s, 0.01 * np.arange(len(samples[0])))
    assert samples[0].button is not None
    assert list(np.flatnonzero(samples[0].button)) == [5]
    assert sorted(kinds) == ["ended", "garbage", "wrap"]


def test_source_1_json() -> None:
    stated = load_source(FOSSILS / "source-1-json.toml")
    decoder = stated.decoder(DecodeTable(kind="fields"), midway=False, messages=True)
    assert isinstance(decoder, JsonValues)
    message = b'{"msg": {"name": ["a", "b"], "position": [1.5, -2], "t": 2500000, "push": true}}'
    assert decoder.feed(message, 3.0, whole=True) == [(3.0, 2.5, (-2.0, 1.5), True)]


def test_source_1_binary() -> None:
    stated = load_source(FOSSILS / "source-1-binary.toml")
    decoder = stated.decoder(DecodeTable(kind="fields"), midway=False, messages=False)
    assert isinstance(decoder, Packets)
    packet = bytes.fromhex("aa55a02526000000c03f000000c001")  # 2500000 µs, 1.5, -2, 1
    crc = 0xFFFF
    for byte in packet[2:]:  # CRC-16/MODBUS as its specification writes it, bit by bit
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ 0xA001 if crc & 1 else crc >> 1
    assert decoder.feed(packet + crc.to_bytes(2, "little"), 3.0) == [(3.0, 2.5, (1.5, -2.0), True)]


def test_journal_1() -> None:
    reading = Reading(FOSSILS / "journal-1.journal")
    records = list(reading)
    assert reading.hello == Hello(("a", "b"), "counts", "a fossil", 100.0)
    assert reading.head["anchor"] == {"utc": "2026-11-30T08:00:00+00:00", "monotonic_s": 1000.0}
    assert [record.kind for record in records] == [HEAD, SAMPLES, TOUCH, EVENT, SAMPLES, WITHDRAWAL]
    assert records[2].content == {"number": 1, "feature": "A"}
    assert records[5].content == {"number": 1, "reason": "ball not seated"}
    first, second = records[1].content, records[4].content
    np.testing.assert_array_equal(first.raw[:, 0], 3.0 * np.arange(8))
    np.testing.assert_array_equal(first.t_device_s, 1000 + np.arange(8) / 100 - 999)
    assert list(np.flatnonzero(first.button)) == [3]
    assert second.raw.tobytes() == np.array([[1.5, 2.5], [np.pi, -0.0]]).tobytes()
    frames, kinds = all_of(f"file:{FOSSILS}/journal-1.journal?speed=max")
    np.testing.assert_allclose(frames[0].q_rad[:, 0], 2 * math.pi * (4092 + np.arange(8)) / 4096)
    assert "wrap" in kinds
