"""A hand that does what a session suggests, with an arm that is off its drawing: a source of samples, and the truth."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import ulna
from ulna.ground.arrays import F64
from ulna.live.faults import Fault
from ulna.live.guide import Suggestion
from ulna.live.samples import Hello, Samples
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource, read_source
from ulna.planning.spec import PlanSpec
from ulna.simulation.mover import Mover


def off_its_drawing(arm: ulna.Arm, hold: list[str], rng: np.random.Generator) -> ulna.Arm:
    """An arm with links some tenths of a millimetre and zeros some milliradians off."""
    from fnmatch import fnmatch

    units = np.array(arm.parameter_units)
    off = np.where(units == "mm", 0.2, 0.0015) * rng.standard_normal(len(units))
    off[[any(fnmatch(name, pattern) for pattern in hold) for name in arm.parameter_names]] = 0.0
    return arm.with_parameters(arm.core.parameters + off)


@dataclass
class Hand:
    """Moves the true arm to where a bar is touched, and holds it there; a source of the arm's angles."""

    truth: ulna.Arm
    spec: PlanSpec
    travel_rad: F64
    rng: np.random.Generator
    rate_hz: float = 1000.0
    noise_rad: float = 5e-6
    t_s: float = 100.0
    dwell_s: float = 0.9
    move_s: float = 0.4
    says_rate: bool = True
    bar_mm: F64 | None = None
    q_rad: F64 | None = None
    samples: deque[Samples] = field(default_factory=deque)
    said: list[Fault] = field(default_factory=list)

    @property
    def hello(self) -> Hello:
        return Hello(
            tuple(f"q{k + 1}" for k in range(self.truth.n)),
            "rad",
            "a simulated hand",
            self.rate_hz if self.says_rate else None,
        )

    def read(self, timeout_s: float) -> Samples:
        if not self.samples:
            raise SourceEnded("the hand rests")
        return self.samples.popleft()

    def faults(self) -> list[Fault]:
        found, self.said = self.said, []
        return found

    def close(self) -> None:
        return

    def stated(self) -> StatedSource:
        return read_source("tcp://nowhere:1")

    def follow(self, suggestion: Suggestion) -> bool:
        """Puts the bar where it is asked for, and touches it; False where the true arm cannot."""
        if not suggestion.here or self.bar_mm is None:
            a, b = suggestion.stand.points_mm
            along, middle = (b - a) / np.linalg.norm(b - a), (a + b) / 2 + 3.0 * self.rng.standard_normal(3)
            half = 0.5 * float(self.spec.artefact.length_mm or 0.0)
            self.bar_mm = np.array([middle - half * along, middle + half * along])
        return self.touch(self.bar_mm[suggestion.feature], suggestion.q_rad)

    def touch(self, point_mm: F64, near_rad: F64) -> bool:
        seat_mm = self.spec.seat_mm * self.rng.standard_normal(3)
        mover = Mover(self.truth, self.travel_rad)
        q_rad, reached = mover.nearby(
            near_rad[None], (point_mm + seat_mm)[None], np.zeros(1, np.int64), {}, int(self.rng.integers(2**60))
        )
        if not reached[0]:
            return False
        self.go(q_rad[0])
        self.hold(self.dwell_s)
        return True

    def go(self, q_rad: F64) -> None:
        begin = q_rad + 0.3 if self.q_rad is None else self.q_rad
        count = int(self.move_s * self.rate_hz)
        way = (1.0 - np.cos(np.linspace(0.0, np.pi, count)))[:, None] / 2.0
        self._send(begin + way * (q_rad - begin))
        self.q_rad = q_rad

    def hold(self, seconds: float, moving_rad: F64 | None = None) -> None:
        assert self.q_rad is not None
        q_rad = np.tile(self.q_rad, (int(seconds * self.rate_hz), 1))
        self._send(q_rad if moving_rad is None else q_rad + moving_rad[: len(q_rad)])

    def _send(self, q_rad: F64) -> None:
        t_s = self.t_s + np.arange(1, len(q_rad) + 1) / self.rate_hz
        self.t_s = float(t_s[-1])
        read = q_rad + self.noise_rad * self.rng.standard_normal(q_rad.shape)
        at = 0
        while at < len(read):
            count = int(self.rng.integers(1, 40))
            piece = slice(at, at + count)
            self.samples.append(Samples(t_s[piece], None, read[piece]))
            at += count


def platinum_plan(test_mm: float = 500.0) -> tuple[ulna.Arm, PlanSpec]:
    from dataclasses import replace

    from ulna.planning.file import load_plan_spec

    arm = ulna.Arm.load("examples/platinum/platinum.toml")
    return arm, replace(load_plan_spec(Path("examples/platinum/plan.toml"), arm), test_mm=test_mm, placements=None)
