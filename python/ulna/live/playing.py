"""A virtual hand at a virtual arm: puts the artefact where it is asked for, and touches it where it is asked for.

It is what somebody without an arm tries a session with. What it touches is where the true arm is, not where it is
thought to be: the artefact stands some millimetres off, and each touch is off by the noise of a seat.
"""

from __future__ import annotations

import numpy as np

from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64, Bool
from ulna.live.guide import Suggestion
from ulna.live.sources.virtual import VirtualSource
from ulna.planning.spec import PlanSpec
from ulna.simulation.mover import Mover

OFF_MM = 3.0
"""How far off an artefact is put, each coordinate: by eye."""
TRIES = 10


class Player:
    """One hand, at the arm of a source."""

    def __init__(self, source: VirtualSource, spec: PlanSpec, seed: int = 0) -> None:
        self._source, self._seat_mm = source, spec.seat_mm
        self._off_mm = OFF_MM if kind_of(spec.artefact).placed(spec.artefact) else 0.0
        self._rng = np.random.default_rng([seed, 61])
        truth = source.arm
        travel = spec.travel_rad if spec.travel_rad is not None else source.travel_rad
        self._mover = Mover(truth, travel)
        self._probe = np.array([truth.probe_index(spec.probe)], dtype=np.int64)
        self._at_mm: F64 | None = None
        """(K, 3) where the features truly are."""

    def follow(self, suggestion: Suggestion) -> bool:
        """Goes there and rests. False where the arm does not reach: nothing is done."""
        at_mm = self._at_mm
        if not suggestion.here or at_mm is None or len(at_mm) != len(suggestion.stand.points_mm):
            at_mm = self._put(suggestion.stand.points_mm, suggestion.q_rad)
        if at_mm is None:
            return False
        there_mm = at_mm[suggestion.feature] + self._seat_mm * self._rng.standard_normal(3)
        q_rad, reached = self._postures(there_mm[None], suggestion.q_rad)
        if not reached[0]:
            return False
        self._at_mm = at_mm
        self._source.go_to(q_rad[0])
        return True

    def _put(self, stands_mm: F64, near_rad: F64) -> F64 | None:
        """About there, where all of it is reached; None where that is nowhere."""
        for _ in range(TRIES):
            at_mm: F64 = stands_mm + self._off_mm * self._rng.standard_normal(3)
            if self._postures(at_mm, near_rad)[1].all():
                return at_mm
        return None

    def _postures(self, points_mm: F64, near_rad: F64) -> tuple[F64, Bool]:
        count, seed = len(points_mm), int(self._rng.integers(2**60))
        near = np.repeat(near_rad[None], count, axis=0)
        return self._mover.nearby(near, np.ascontiguousarray(points_mm), np.repeat(self._probe, count), {}, seed)
