"""A virtual arm plays a plan: it stands artefacts in its reach and touches them, with noise. mm and rad."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import NOTHING, REFERENCE_C
from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.simulation.mover import Mover
from ulna.simulation.reading_errors import ReadingErrors, turns
from ulna.verification.kinds.registry import kind_of
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import Wanted, WantedBall
from ulna.verification.plan_files import Filled
from ulna.verification.profile import Profile
from ulna.verification.steps import artefacts_of, steps_of

FIXTURE_MM = 0.001
#: of the sum of the links: what an arm's maker would call its reach
REACHED = 0.8
#: places tried at once, and how often
PLACES, ROUNDS = 6, 300


@dataclass(frozen=True)
class Played:
    """What was played."""

    filled: Filled
    """The plan's values, as a certificate states them."""
    q_rad: F64
    """(N, n) readings, a row for each step."""
    truth: dict[str, float]
    """True length or diameter of each artefact, mm."""


def play(
    profile: Profile, truth: Arm, encoder_rad: float, touch_mm: float, seed: int, progress: Progress | None = None
) -> Played:
    """All touches of a profile with a true arm of one probe. Raises UlnaInputError where something is out of reach.

    encoder_rad: standard deviation of each encoder; touch_mm: of a touch, per coordinate. Elbow and wrist are drawn at
    random for each touch, whatever orientation the list asks for.
    """
    truth.check_turns("test plan", "test plans")
    if len(truth.probes) != 1:
        raise UlnaInputError(
            f"arm '{truth.name}' has {len(truth.probes)} probes; expected one to play a plan with. Remove the others."
        )
    tip_mm = next(iter(truth.probes.values())).ball_mm
    if tip_mm is None:
        raise UlnaInputError(
            f"arm '{truth.name}': the diameter of its probe's ball is not known; expected it to touch with. Add "
            "ball = … to the probe."
        )
    rng = np.random.default_rng([seed, 12])
    travel = np.array([joint.travel_rad or (-np.pi, np.pi) for joint in truth.joints])
    margin = 6.0 * encoder_rad
    mover = Mover(truth, travel + np.array([margin, -margin]))
    range_mm = range_of(truth)
    # a ball stands beside every virtual arm, so that one seed plays the same touches whether it is used or not
    wanted = {each.name: each for each in (WantedBall(), *artefacts_of(profile.file))}
    stated, true_mm = _stated(wanted.values(), range_mm, rng)
    player = StepPlayer(mover, tip_mm, wanted, true_mm, 0.5 * range_mm, touch_mm, rng)
    steps = steps_of(profile.file)
    runs = [list(run) for _, run in groupby(steps, lambda step: (step.test, step.artefact, step.position))]
    parts: list[F64] = []
    done = 0
    for run in runs:
        parts.append(player.run(run))
        done += len(run)
        if progress is not None:
            progress("playing", done, len(steps))
    errors = ReadingErrors(np.full(truth.n, encoder_rad), touch_mm)
    filled = Filled(
        range_mm=range_mm,
        artefacts=stated,
        mpe={key: limit for table in profile.file.test.values() for key, limit in kind_of(table.kind).limits.items()},
        temperature={"value": REFERENCE_C, "u": 0.1},
        fixture_mm=FIXTURE_MM,
    )
    return Played(filled, errors.read(np.concatenate(parts), rng), true_mm)


def range_of(arm: Arm) -> float:
    """The diameter of the measuring range that a maker would state of such an arm, mm."""
    return round(2.0 * REACHED * arm.core.reach_mm(0), -1)


def _stated(
    wanted: Iterable[Wanted], range_mm: float, rng: np.random.Generator
) -> tuple[dict[str, dict[str, Any]], dict[str, float]]:
    """Artefacts as certificates state them, and as they are."""
    stated: dict[str, dict[str, Any]] = {}
    true_mm: dict[str, float] = {}
    for each in wanted:
        if each.SIZE is not None:
            table = stated[each.name] = each.stated(range_mm)
            true_mm[each.name] = table[each.SIZE] + table["u"] * float(rng.standard_normal())
    return stated, true_mm


@dataclass
class StepPlayer:
    """Stands artefacts in the reach of a true arm, and touches them."""

    mover: Mover
    tip_mm: float
    wanted: dict[str, Wanted]
    """By the name that steps have."""
    true_mm: dict[str, float]
    reach_mm: float
    touch_mm: float
    rng: np.random.Generator

    def run(self, steps: list[Step]) -> F64:
        """(N, n) true postures at the steps of one artefact in one place."""
        first = steps[0]
        artefact = self.wanted[first.artefact]
        local_mm = artefact.touched(steps, self.true_mm.get(first.artefact, 0.0), self.tip_mm)
        between = artefact.between(first.position)
        probe = np.zeros(len(steps) * PLACES, dtype=np.int64)
        for _ in range(ROUNDS):
            axes = turns(np.eye(3), PLACES, self.rng)
            origin_mm = self._origins(between, local_mm, axes)
            at_mm = origin_mm[:, None] + local_mm @ axes
            at_mm += self.touch_mm * self.rng.standard_normal(at_mm.shape)
            flat = at_mm.reshape(-1, 3)
            q_rad, reached = self.mover.on_points(flat, probe, NOTHING, int(self.rng.integers(2**63)))
            whole = reached.reshape(PLACES, -1).all(axis=1)
            if whole.any():
                return np.asarray(q_rad.reshape(PLACES, len(steps), -1)[int(np.argmax(whole))])
        raise UlnaInputError(
            f"arm '{self.mover.arm.name}': no place was found where all of {first.artefact or 'a seat'} (test "
            f"'{first.test}', position {first.position or '1'}) is within reach; expected an artefact that fits. Take "
            "a profile with shorter lengths, or an arm with wider limits."
        )

    def _origins(self, between: tuple[float, float] | None, local_mm: F64, axes: F64) -> F64:
        """(PLACES, 3) such that the first touch is where the tip can be: anywhere, or at so much of the reach."""
        if between is None:
            poses = self.mover.anywhere(PLACES, self.rng)
            return np.asarray(self._tips(poses) - local_mm[0] @ axes)
        low, high = between
        tips = self._tips(self.mover.anywhere(800 * PLACES, self.rng))
        share = np.linalg.norm(tips, axis=1) / self.reach_mm
        away = np.maximum(low - share, share - high)
        return np.asarray(tips[np.argsort(np.maximum(away, 0.0), kind="stable")[:PLACES]])

    def _tips(self, q_rad: F64) -> F64:
        return np.asarray(self.mover.arm.core.tip(q_rad, 0))
