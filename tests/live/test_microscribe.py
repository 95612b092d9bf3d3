"""`microscribe:` against a double of the device on a pseudo-terminal; no device was at hand."""

from __future__ import annotations

import random
import struct
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.live.microscribe_device import ALPHA, COUNTS, A, D, Device, plugged, tip_mm
from tests.live.parts import collected, pty

from ulna.arm.arm import Arm
from ulna.ground.errors import UlnaInputError
from ulna.live.commission.commissioning import Commissioning
from ulna.live.commission.geometry import geometry, ways
from ulna.live.faults import ENDED, GARBAGE
from ulna.live.journal import Journal, Reading
from ulna.live.mapping import Mapping
from ulna.live.microscribe.replies import Replies
from ulna.live.registry import device_arm, open_wire, opened
from ulna.live.samples import Hello
from ulna.live.source import SourceEnded
from ulna.live.source_file import read_source
from ulna.live.sources import microscribe
from ulna.live.stream import streaming
from ulna.live.tables import MapTable

N = 120
RAW = np.random.default_rng(7).integers(0, 16384, (N, 5))
"""As the registers hold them: past a turn of the smaller encoders."""


def test_what_is_polled_comes_cut_at_will_with_garbage_between() -> None:
    def spoil(k: int, reply: bytes) -> bytes:
        return {
            20: b"\xff\xfe" + reply,  # between two replies
            40: reply[:5] + b"\x11" + reply[5:],  # a byte too many
            60: reply[:7] + reply[8:],  # one that was lost
            61: reply[:7] + b"\x99" + reply[8:],  # one that was disturbed
            80: b"",  # none at all
        }.get(k, reply)

    device = Device(RAW.tolist(), spoil=spoil)
    with plugged(device) as line, opened(f"microscribe:{line.path}?rate=1000&wait=20") as source:
        samples, faults, _ = collected(source, N - 4)
        assert source.hello == Hello(
            ("q1", "q2", "q3", "q4", "q5"), "counts", f"MicroScribe3D DX 12345 at {line.path}", None, COUNTS
        )
    kept = [k for k in range(N) if k not in (40, 60, 61, 80)]
    np.testing.assert_array_equal(samples.raw[: len(kept)], RAW[kept] % np.array(COUNTS))
    assert [fault.kind for fault in faults] == [GARBAGE] * 3  # 60 and 61 are one run
    assert np.all(np.diff(samples.t_host_s) >= 0)
    assert device.ended >= 1
    assert device.homed == 0


def test_however_replies_are_cut_rows_are_the_same() -> None:
    device = Device(RAW.tolist())
    device.state = "open"
    stream = device.hears(b"\x03" * N)
    cuts = random.Random(11)
    for _ in range(20):
        replies, rows, rest = Replies((*COUNTS, 4096), 3), [], stream + b"\x83"
        while rest:
            n = cuts.randrange(1, 40)
            rows += replies.feed(rest[:n], 0.0)
            rest = rest[n:]
        np.testing.assert_array_equal([row.values[:5] for row in rows], RAW % np.array(COUNTS))
        assert replies.skipped.bytes == 0


def test_bytes_that_are_no_replies_do_not_pile_up() -> None:
    replies = Replies(COUNTS, 3)
    assert replies.feed(b"\x01" * 10_000, 1.0) == []
    assert replies.skipped.bytes > 9_900


def test_counts_become_angles_by_what_the_device_says() -> None:
    with plugged(Device(RAW.tolist())) as line, streaming(f"microscribe:{line.path}?rate=1000") as stream:
        frames = stream.read(5.0)
        while not len(frames.samples):
            frames = stream.read(5.0)
    turns = RAW[: len(frames.q_rad)] / np.array(COUNTS) - frames.q_rad / (2 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)
    np.testing.assert_allclose(frames.q_rad[0], 2 * np.pi * (RAW[0] % COUNTS) / COUNTS, rtol=1e-15)


@pytest.mark.parametrize(("pedal", "down"), [("any", [1, 2, 3]), ("right", [1, 3]), ("left", [2, 3])])
def test_pedals(pedal: str, down: list[int]) -> None:
    device = Device(buttons=[0, 1, 2, 3, 0])
    with plugged(device) as line, opened(f"microscribe:{line.path}?rate=1000&pedal={pedal}") as source:
        samples, _, _ = collected(source, 5)
    assert samples.button is not None
    assert list(np.flatnonzero(samples.button)) == down


def test_without_pedals_there_is_no_button() -> None:
    with plugged(Device(pedals=0)) as line, opened(f"microscribe:{line.path}") as source:
        samples, _, _ = collected(source, 2)
    assert samples.button is None


def test_a_sixth_encoder_is_asked_for() -> None:
    device = Device([(1, 2, 3, 4, 5, 6)], maxima=(16383, 16383, 8191, 4095, 4095, 1023))
    with plugged(device) as line, opened(f"microscribe:{line.path}") as source:
        samples, _, _ = collected(source, 2)
        assert source.hello.counts_per_turn == (*COUNTS, 1024)
    assert samples.raw[0].tolist() == [1, 2, 3, 4, 5, 6]


def test_a_session_left_open_is_ended_and_the_registers_are_not_touched() -> None:
    device = Device([(5, 6, 7, 8, 9)], begun=True)
    with plugged(device) as line, opened(f"microscribe:{line.path}") as source:
        samples, _, _ = collected(source, 1)
    assert samples.raw[0].tolist() == [5, 6, 7, 8, 9]
    assert (device.begun, device.homed) == (1, 0)


def test_a_pulled_cable() -> None:
    with plugged(Device(RAW.tolist())) as line, opened(f"microscribe:{line.path}") as source:
        collected(source, 5)
        line.pull()
        _, faults, why = collected(source, N)
        with pytest.raises(SourceEnded):
            source.read(0.1)
    assert why is not None
    assert "cable was pulled" in why
    assert [fault.kind for fault in faults] == [ENDED]


def test_a_cable_pulled_at_the_device(monkeypatch: pytest.MonkeyPatch) -> None:
    """The port is still there, and says nothing of it."""
    monkeypatch.setattr(microscribe, "SILENT_S", 0.5)
    with plugged(Device(RAW.tolist())) as line, opened(f"microscribe:{line.path}") as source:
        collected(source, 5)
        line.silent = True
        _, faults, why = collected(source, N)
    assert why == (
        f"MicroScribe3D DX 12345 at {line.path}: no answer for 0.5 s: the cable was pulled, or the device is off."
    )
    assert [fault.kind for fault in faults] == [ENDED]


def test_pulled_while_it_greets() -> None:
    with pty() as line:
        import threading

        threading.Timer(0.3, line.pull).start()
        with pytest.raises(UlnaInputError, match="No reading came before"), opened(f"microscribe:{line.path}?wait=10"):
            pass


@pytest.mark.parametrize(
    ("device", "words"),
    [
        (Device(answers=lambda asked: b"" if asked == b"IMMC" else None), r"the greeting in 1\.5 s\. Expected"),
        (
            Device(answers=lambda asked: b"start\n" if asked == b"IMMC" else None),
            r"\d+ bytes came that are none: 'start\\nst",
        ),
        (Device(answers=lambda asked: b"" if asked == b"BEGIN" else None), "when asked for BEGIN in 2 s .nothing came"),
        (Device(texts={0: b"PROBE"}), "says that it is 'PROBE'; expected 'MSCR'"),
        (Device(texts={0xCA: b"D\xffX"}), "said 44ff58.* of itself; expected a word"),
        (Device(answers=lambda asked: b"\xcb123" if asked == b"\xcb" else None), "for its serial in 2 s .4 bytes"),
        (Device(maxima=(16383, 9999, 8191, 4095, 4095, 0)), "count to 16383, 9999, .*; expected a power of two"),
        (Device(maxima=(0,) * 6), "count to 0, 0"),
        (Device(maxima=(16383, 0, 8191, 4095, 4095, 0)), "expected a power of two"),
    ],
)  # fmt: skip
def test_what_is_no_microscribe_is_said(device: Device, words: str) -> None:
    with plugged(device) as line:
        with pytest.raises(UlnaInputError, match=words), opened(f"microscribe:{line.path}?wait=1.5"):
            pass
        assert device.homed == 0


def test_numbers_that_come_otherwise_the_second_time() -> None:
    asked = []

    def answers(command: bytes) -> bytes | None:
        asked.append(command)
        return (
            b"\xc6" + device.maxima[:-3] + b"\x1f\x00\x00" if asked.count(b"\xc6") == 1 and command == b"\xc6" else None
        )

    device = Device(answers=answers)
    with (
        plugged(device) as line,
        pytest.raises(UlnaInputError, match=r"greatest counts came as .* asked again, as .*; expected the same"),
        opened(f"microscribe:{line.path}"),
    ):
        pass


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("microscribe:", "expected microscribe:PORT, such as microscribe:/dev"),
        ("microscribe:/dev/nowhere", "cannot be opened"),
        ("microscribe:/dev/nowhere?baud=250000", "got '250000', expected 9600 or 14400"),
        ("microscribe:/dev/nowhere?parity=even", "unknown option 'parity'"),
        ("microscribe:/dev/nowhere?pedal=middle", "expected any or right or left"),
    ],
)
def test_urls_that_are_wrong(url: str, words: str) -> None:
    with pytest.raises(UlnaInputError, match=words), opened(url):
        pass


def test_there_are_no_bytes_to_be_guessed_at() -> None:
    with pytest.raises(UlnaInputError, match="brings readings, not bytes"):
        open_wire(read_source("microscribe:/dev/nowhere"))


def test_other_counts_than_the_device_says_are_refused(tmp_path: Path) -> None:
    hello = Hello(("q1", "q2"), "counts", "a double", None, (4096, 8192))
    assert Mapping(MapTable(channels=["q2", "q1"]), hello).turn.tolist() == [8192, 4096]
    assert Mapping(MapTable(counts_per_turn=[4096, 8192]), hello).turn.tolist() == [4096, 8192]
    with pytest.raises(UlnaInputError, match=r"got 4096\.0, but a double says 4096, 8192"):
        Mapping(MapTable(counts_per_turn=4096), hello)
    with pytest.raises(UlnaInputError, match="got 'deg', but a double sends counts"):
        Mapping(MapTable(unit="deg"), hello)


def test_a_journal_keeps_what_the_device_says(tmp_path: Path) -> None:
    path = tmp_path / "run.journal"
    with (
        plugged(Device(RAW.tolist())) as line,
        opened(f"microscribe:{line.path}?rate=1000") as source,
        Journal.create(path, source.hello) as journal,
    ):
        samples, _, _ = collected(source, 20)
        journal.samples(samples)
    with streaming(f"file:{path}?speed=max") as stream:
        assert stream.source.hello == source.hello
        np.testing.assert_allclose(
            stream.read(5.0).q_rad[0], 2 * np.pi * (RAW[0] % COUNTS) / COUNTS, rtol=1e-15
        )  # fmt: skip


@pytest.mark.parametrize("counts", [(0.5, 4096), (4096,), (True, 4096), (float("nan"), 4096)])
def test_a_journal_that_says_nonsense_of_counts_is_damaged(counts: tuple[float, ...], tmp_path: Path) -> None:
    with Journal.create(tmp_path / "run.journal", Hello(("q1", "q2"), "counts", "a double", None, counts)):
        pass
    with pytest.raises(UlnaInputError, match="head of the journal is not whole"):
        Reading(tmp_path / "run.journal")


def test_its_own_table_puts_the_tip_where_its_own_chain_does() -> None:
    """A point through 6 × 5 elementary motions (the double's), against Ulna's arm."""
    device = Device(begun=True)
    with plugged(device) as line:
        drawn = device_arm(read_source(f"microscribe:{line.path}"))
        assert drawn is not None
        with opened(f"microscribe:{line.path}") as source:  # the session was ended
            assert len(source.read(5.0)) >= 0
    assert drawn.said == "as MicroScribe3D DX 12345 itself tells it (Format DH0.5, firmware HCI 2.0)"
    arm = drawn.arm
    assert [joint.counts_per_turn for joint in arm.joints] == list(COUNTS)
    assert [joint.model for joint in arm.joints] == ["dh", "hayati", "dh", "dh", "dh"]
    q_rad = 2 * np.pi * RAW / np.array(COUNTS)
    np.testing.assert_allclose(arm.tip(q_rad), [tip_mm(row) for row in RAW], atol=1e-9)


@pytest.mark.parametrize("beta", [0, 3, -900])
@pytest.mark.parametrize("sixth", [False, True])
def test_tables_of_other_devices(beta: int, sixth: bool) -> None:
    rng = np.random.default_rng(beta + 1000)
    alpha, a, d = (tuple(int(each) for each in rng.integers(-32768, 32767, 6)) for _ in range(3))
    turns = (*COUNTS, 1024) if sixth else COUNTS
    device = Device(
        maxima=[*(each - 1 for each in turns), 0][:6], block=struct.pack(">18h", *alpha, *a, *d), beta=beta
    )  # fmt: skip
    with plugged(device) as line:
        drawn = device_arm(read_source(f"microscribe:{line.path}"))
    assert drawn is not None
    counts = rng.integers(0, 16384, (40, len(turns)))
    on_axis_1 = [tip_mm(row, (0, *alpha[1:]), (0, *a[1:]), d, beta, turns) for row in counts]
    np.testing.assert_allclose(drawn.arm.tip(2 * np.pi * counts / np.array(turns)), on_axis_1, atol=1e-8)
    assert "its base frame stands on axis 1" in drawn.said


def test_of_right_angles_the_tip_is_a_sum_of_lengths() -> None:
    """All angles 0: along x all a; of d the first goes up, the fourth down, the last up, the second, third and fifth
    along -y. A quarter turn of the first joint makes x to y."""
    right = (0, 0x4000, 0, 0x4000, -0x4000, -0x4000)
    device = Device(block=struct.pack(">18h", *right, *A, *D), texts={0xCC: b"Standard"}, beta=4000)
    with plugged(device) as line:
        drawn = device_arm(read_source(f"microscribe:{line.path}"))
    assert drawn is not None
    x, y, z = 0.0254 * np.array([sum(A), -(D[1] + D[2] + D[4]), D[0] - D[3] + D[5]])
    np.testing.assert_allclose(drawn.arm.tip([0.0] * 5), [x, y, z], atol=1e-10)
    np.testing.assert_allclose(drawn.arm.tip([np.pi / 2, 0, 0, 0, 0]), [-y, x, z], atol=1e-10)
    assert b"\xd3" not in device.heard  # a device without beta does not answer that


@pytest.mark.parametrize(
    ("device", "words"),
    [
        (Device(texts={0xCD: b"Format 1.1"}), "gives its geometry as 'Format 1.1'; expected 'Format DH0.5'"),
        (Device(block=bytes(34)), "its parameters are 34 bytes; expected 36"),
        (Device(maxima=(16383, 16383, 8191, 4095, 0, 0)), "has 4 encoders; expected 5 or 6"),
    ],
)
def test_a_geometry_that_is_not_known(device: Device, words: str) -> None:
    with plugged(device) as line, pytest.raises(UlnaInputError, match=words):
        device_arm(read_source(f"microscribe:{line.path}"))


def test_other_sources_tell_no_geometry() -> None:
    assert device_arm(read_source("virtual:")) is None


def test_alpha_is_that_of_the_device_that_was_read() -> None:
    """The nominal twists of the manual's figure, to a degree: a slip in the double's own table would be seen."""
    degrees = np.array(ALPHA) * 180 / 32768
    assert np.abs(degrees - [0, 90, 0, 90, -90, -90]).max() < 1


def test_its_geometry_as_a_file(tmp_path: Path) -> None:
    out = tmp_path / "arm.toml"
    with plugged(Device()) as line:
        done = run("live", "geometry", f"microscribe:{line.path}", "-o", out)
        assert done.returncode == 0, done.stderr
        assert_bad_input(run("live", "geometry", f"microscribe:{line.path}", "-o", out), "exists already")
    assert "as MicroScribe3D DX 12345 itself tells it" in out.read_text()
    np.testing.assert_allclose(
        Arm.load(out).tip(2 * np.pi * RAW / np.array(COUNTS)), [tip_mm(row) for row in RAW], atol=1e-6
    )
    assert_bad_input(
        run("live", "geometry", "virtual:", "-o", tmp_path / "other.toml"),
        "tells no geometry; expected one of microscribe:",
    )
    assert not (tmp_path / "other.toml").exists()


def test_commissioning_begins_with_its_geometry(tmp_path: Path) -> None:
    with plugged(Device()) as line:
        url = f"microscribe:{line.path}"
        drawn = geometry(None, None, None, url)
        assert drawn == device_arm(read_source(url))
        assert "as the device draws it" in (ways(drawn, "the device")[4] or "")
        assert geometry(None, 5, 900.0, url).guessed  # --reach says that it is to be guessed
        done = run("live", "commission", url, "--joints", "6", "--yes", "-o", tmp_path / "no")
        assert_bad_input(done, "--joints: got 6, but", "has 5")
        with opened(url) as source:
            work = Commissioning(source.hello, drawn.arm.n, MapTable())
    assert work.known.stated.tolist() == list(COUNTS)
    assert work.known.unit()[0] == "counts"
