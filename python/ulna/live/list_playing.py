"""A virtual hand that touches by a list: it stands each artefact in the reach of its arm, and touches it step by step.

What `ulna verify --play` writes at once, for whoever wants to see it done.
"""

from __future__ import annotations

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.sources.virtual import VirtualSource
from ulna.simulation.mover import Mover
from ulna.verification.player import StepPlayer, range_of
from ulna.verification.to_touch import WorkList

TOUCH_MM = 0.005
"""Standard deviation of a touch, per coordinate, as of `ulna verify --play`."""
MARGIN_RAD = np.radians(1.0)
"""A joint that is nearer to its stop is not trusted."""


class ListHand:
    """One hand, at the arm of a source."""

    def __init__(self, source: VirtualSource, work: WorkList, seed: int = 0) -> None:
        """Raises UlnaInputError for an arm with several probes, which no hand tells apart."""
        if len(source.arm.probes) != 1:
            raise UlnaInputError(
                worded(
                    "arm '{arm}' has {count} probes; expected one to play with. Move it by hand.",
                    arm=source.arm.name,
                    count=len(source.arm.probes),
                )
            )
        self._source, self._work, self._seed = source, work, seed
        mover = Mover(source.arm, source.travel_rad + np.array([MARGIN_RAD, -MARGIN_RAD]))
        self._player = StepPlayer(
            mover,
            work.tip_mm,
            {each.step.artefact: each.wanted for each in work.listed},
            {each.step.artefact: each.true_mm for each in work.listed},
            0.5 * range_of(source.arm),
            TOUCH_MM,
            np.random.default_rng([seed, 62, 0]),
        )
        self._postures: dict[int, F64] = {}
        """Of the steps of the places where something was put."""
        self._at: int | None = None

    def follow(self, step: int) -> None:
        """Goes to a step and rests; with another elbow where it is there already. Raises UlnaInputError where nothing
        that is to be touched fits into the arm's reach."""
        if step not in self._postures:
            standing = self._work.listed[step].standing
            own = [k for k, each in enumerate(self._work.listed) if each.standing == standing]
            # by its number: a session that goes on finds everything where it stood
            self._player.rng = np.random.default_rng([self._seed, 62, own[0]])
            found = self._player.run([self._work.listed[k].step for k in own])
            self._postures.update(zip(own, found, strict=True))
        q_rad = self._postures[step]
        if step == self._at:
            q_rad = self._otherwise(q_rad)
        self._at = step
        self._source.go_to(q_rad)

    def _otherwise(self, q_rad: F64) -> F64:
        """Another posture with the tip in the same place."""
        mover = self._player.mover
        at_mm = mover.arm.core.tip(np.ascontiguousarray(q_rad[None]), 0)
        seed = int(self._player.rng.integers(2**60))
        found, reached = mover.on_points(at_mm, np.zeros(1, dtype=np.int64), {}, seed)
        return np.asarray(found[0]) if reached[0] else q_rad
