"""Faults that come again and again: told a few times whole, then counted; none is lost, and nothing drowns."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from tests.cli_runs import run
from tests.live.hands import RATE_HZ, hand, near, source

from ulna.ground.arrays import F64
from ulna.live.faults import GAP, JUMP, Fault
from ulna.live.features import Notebook
from ulna.live.figures import Calibrated
from ulna.live.floods import EVERY_S, WHOLE, Floods
from ulna.live.journal import EVENT, Reading
from ulna.live.readout import ReadOut
from ulna.live.source import SourceEnded
from ulna.live.stream import streaming
from ulna.live.trigger import Refused


def jump(t_s: float) -> Fault:
    return Fault(JUMP, t_s, f"at {t_s:g} s.")


def stood() -> float:
    """A clock that does not go."""
    return 0.0


def test_a_few_are_told_whole_and_the_others_counted() -> None:
    floods = Floods(stood)
    told = [each for k in range(1000) for each in floods.told([jump(0.025 * k)])]  # 40 a second for 25 s
    told += floods.rest()
    assert told[:WHOLE] == [jump(0.025 * k) for k in range(WHOLE)]
    assert [each.kind for each in told] == [JUMP] * len(told)
    assert WHOLE + sum(each.more for each in told) == 1000
    assert len(told) == WHOLE + 3  # after 10 s, after 20 s, at the end
    assert told[WHOLE].text == f"{400 - WHOLE} more in 10.0 s, the last: at 9.975 s."
    assert told[WHOLE].as_dict()["more"] == 400 - WHOLE
    assert "more" not in told[0].as_dict()
    assert floods.rest() == []


def test_what_is_rare_is_told_whole() -> None:
    floods = Floods(stood)
    faults = [jump((EVERY_S + 1.0) * k) for k in range(50)]
    assert floods.told(faults) == faults
    floods = Floods(stood)
    mixed = [jump(0.1 * k) for k in range(9)] + [Fault(GAP, 1.0, "a gap of 200 ms in the stream.")]
    assert floods.told(mixed)[-1].kind == GAP  # another kind has its own count
    one = Floods(stood)
    assert one.told([jump(0.1 * k) for k in range(WHOLE + 1)]) == [jump(0.1 * k) for k in range(WHOLE)]
    assert one.rest() == [jump(0.1 * WHOLE)]  # a single one need not be counted


def test_a_count_is_told_though_no_more_come() -> None:
    now = [0.0]
    floods = Floods(lambda: now[0])
    floods.told([jump(0.01 * k) for k in range(100)])
    now[0] = 0.9 * EVERY_S
    assert floods.told([]) == []
    now[0] = EVERY_S
    assert [each.more for each in floods.told([])] == [100 - WHOLE]
    now[0] = 2.0 * EVERY_S
    assert floods.told([]) == []
    assert floods.told([jump(30.0)]) == [jump(30.0)]  # it had ended: the next is whole again


def flood(seconds: float = 25.0) -> F64:
    """(N, 7) a joint that jumps by a right angle with each reading."""
    q_rad = np.tile(near(1)[0], (int(seconds * RATE_HZ), 1))
    q_rad[::2, 2] += 0.5 * np.pi
    return q_rad


def test_watch_record_and_measure_do_not_drown(result: Path, tmp_path: Path) -> None:
    q_rad = flood()
    jumps, toml, journal = len(q_rad) - 1, source(tmp_path, q_rad), tmp_path / "run.journal"
    for words in (["watch", toml], ["measure", result, toml, "--probe", "bent"]):
        lines = [json.loads(line) for line in run("live", *words, "--json").stdout.splitlines()]
        told = [line["fault"] for line in lines if "fault" in line]
        assert len(told) < 10
        assert sum(each.get("more", 1) for each in told) == jumps == lines[-1]["end"]["faults"]["jump"]
        done = run("live", *words)
        assert done.returncode == 0, done.stderr
        assert sum(line.startswith("jump: ") for line in done.stderr.splitlines()) == len(told)
        assert " more in " in done.stderr
        assert f"jump {jumps}" in done.stdout
    assert run("live", "record", toml, "-o", journal).returncode == 0
    kept = [record.content for record in Reading(journal) if record.kind == EVENT]
    assert [each["kind"] for each in kept] == ["jump"] * len(told) + ["end"]
    assert sum(each.get("more", 1) for each in kept[:-1]) == jumps


def test_a_fault_that_is_only_counted_is_a_doubt_all_the_same(result: Path, tmp_path: Path) -> None:
    """After many jumps somebody says that the angles are right; the next jump is not told, and yet no touch follows."""
    q_rad = np.concatenate([flood(0.5), hand(near(1))])
    q_rad[-150:, 2] += 0.5 * np.pi
    with streaming(source(tmp_path, q_rad, speed="1")) as stream:
        out = ReadOut(stream, Calibrated(result, "bent"), Notebook())
        count = 0
        while True:
            try:
                frames = stream.read(0.1)
            except SourceEnded:
                break
            if count <= len(q_rad) - 150 < count + len(frames.samples):
                assert [fault.kind for fault in frames.faults] == [JUMP]
                assert frames.told == []
            list(out.take(frames))
            count += len(frames.samples)
            if count <= len(q_rad) - 150:
                out.trust()
        assert out.doubt is not None
        assert isinstance(out.ask(), Refused)
        assert sum(each.more for each in stream.ended().told) > 0
