"""The evening of examples/evening without its clock: the hand hears what the commands say, and does it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import ulna
from ulna.live.commission.commissioning import Commissioning
from ulna.live.commission.geometry import geometry
from ulna.live.commission.posture import posture
from ulna.live.commission.writing import write
from ulna.live.events import Happened
from ulna.live.faults import Fault
from ulna.live.purpose import purpose_of
from ulna.live.said import happened_lines, meter_lines
from ulna.live.samples import Hello, Samples
from ulna.live.session import Session
from ulna.live.source import SourceEnded
from ulna.live.source_file import load_source, read_source
from ulna.live.stream import Stream
from ulna.live.tables import MapTable

EXAMPLE = Path("examples/evening").resolve()
GOAL_MM = 0.04


class OffLine:
    """The Arduino, as fast as it is read: what it prints until it rests, and some seconds more."""

    def __init__(self, arm: object, rest_s: float = 4.5) -> None:
        self.arm, self.rest, self.t_s, self._more = arm, int(rest_s * 200), 100.0, 0
        self.hello = Hello(tuple(f"c{k}" for k in range(2, 8)), None, "an Arduino", 200.0)

    def read(self, timeout_s: float) -> Samples:
        rows = []
        while len(rows) < 50 and (self.arm.moves or self._more < self.rest):  # type: ignore[attr-defined]
            self._more = 0 if self.arm.moves else self._more + 1  # type: ignore[attr-defined]
            rows.append([float(each) for each in self.arm.line().split(",")[1:]])  # type: ignore[attr-defined]
        if not rows:
            self._more = 0
            raise SourceEnded("it rests")
        t_s = self.t_s + np.arange(1, len(rows) + 1) / 200.0
        self.t_s = float(t_s[-1])
        return Samples(t_s, None, np.array(rows))

    def rests(self) -> None:
        """What is left until it rests."""
        try:
            while True:
                self.read(0.0)
        except SourceEnded:
            return

    def faults(self) -> list[Fault]:
        return []

    def close(self) -> None:
        return


@pytest.fixture
def evening(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[object, object]]:
    monkeypatch.syspath_prepend(str(EXAMPLE))
    import play

    import home_built

    yield home_built, play
    for name in ("home_built", "play"):
        sys.modules.pop(name, None)


def test_the_hand_that_hears_ends_with_an_arm_that_measures(evening: tuple, tmp_path: Path) -> None:
    """From counts of unknown cables, signs and zeros to lengths that are right within their U."""
    home_built, play = evening
    arm = home_built.HomeBuilt(EXAMPLE / "drawing.toml", seed=3)
    hand, source = play.Hand(arm), OffLine(arm)
    drawn = geometry(EXAMPLE / "drawing.toml", None, None)
    table = MapTable(unit="counts", counts_per_turn=home_built.COUNTS)
    work = Commissioning(source.hello, 6, table, posture=posture(drawn.arm))
    while (step := work.step) is not None:
        hand.commissions(step.sentence)
        found = None
        while found is None:
            found = work.take(source.read(0.0))
        assert found.why_not is None, found.said
        work.accept()
        source.rests()
        work.forget()
    write(work.findings(), read_source("tcp://nowhere:1"), drawn, tmp_path / "my-arm")
    made = ulna.Arm.load(tmp_path / "my-arm" / "arm.toml")
    assert [joint.sign for joint in made.joints] == list(home_built.SIGNS)

    play.fill_in(tmp_path / "my-arm" / "plan.toml")
    arm.go(arm.middle_rad)
    purpose = purpose_of(tmp_path / "my-arm" / "plan.toml", made, None, 300.0)
    stream = Stream(source, load_source(tmp_path / "my-arm" / "source.toml"))
    session = Session(made, purpose.spec, stream, fit=purpose.fit, goal_u_mm=GOAL_MM / 2)
    events: list[object] = []
    for _ in range(40):
        meter = session.meter()
        if session.fit.fitted is not None and meter.worth.u_mm <= GOAL_MM / 2:
            break
        lines = meter_lines(meter)
        if events and isinstance(events[-1], Happened):
            lines = happened_lines(events[-1], ["A", "B"]) + lines
        for line in lines:
            hand.touches(line)
        try:
            while True:
                events += session.feed(session.stream.read(0.0))
        except SourceEnded:
            continue
    taken = session.fit.counting()
    assert 8 <= len(taken) <= 30

    # lengths anywhere: the arm that came out, and what it truly is
    q_rad = session.guide.test_rad.reshape(-1, 6)
    half_a_count = np.pi / home_built.COUNTS  # counts are rounded down
    before, after = (_lengths(each, q_rad) for each in (made, session.arm_now))
    truth = _lengths(arm.built.arm, q_rad + half_a_count)
    off_mm = [float(np.sqrt(np.mean((each - truth) ** 2))) for each in (before, after)]
    assert off_mm[0] > 5.0
    assert off_mm[1] < 2.0 * session.meter().worth.u_mm


def _lengths(arm: ulna.Arm, q_rad: np.ndarray) -> np.ndarray:
    ends = arm.tip(q_rad).reshape(-1, 2, 3)
    found: np.ndarray = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return found
