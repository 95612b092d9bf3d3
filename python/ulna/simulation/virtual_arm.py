"""A virtual arm: it moves, it touches, its encoders are read, and the truth is known. Angles rad, lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64
from ulna.simulation.mover import Mover
from ulna.simulation.places import Standing, places
from ulna.simulation.reading_errors import ReadingErrors

PATIENT = 400
"""Random elbows and wrists to try for a point, so that one at the edge of the arm's travel is not given up."""


@dataclass(frozen=True)
class VirtualArm(Mover):
    """The true arm, how far its joints turn, and how its readings err. It touches with its first probe."""

    errors: ReadingErrors

    def touch(self, points_mm: F64, seed: int, rng: np.random.Generator) -> F64:
        """(N, n) readings with the ball in seats at (N, 3) points: seat noise, elbow at random, encoder noise.

        Raises ValueError for points out of reach.
        """
        beside = points_mm + self.errors.seat_mm * rng.standard_normal(points_mm.shape)
        q_rad, reached = self.on_points(beside, np.zeros(len(beside), dtype=np.int64), {}, seed, PATIENT)
        if not reached.all():
            raise ValueError(f"{int((~reached).sum())} of {len(reached)} points are out of the virtual arm's reach")
        return self.errors.read(q_rad, rng)

    def places(self, features_mm: F64, count: int, rng: np.random.Generator) -> F64:
        """(count, K, 3) where the (K, 3) features of an artefact are when it stands in random places and directions,
        all of them within reach. Raises UlnaInputError where that is not found."""
        at_mm, _ = places(Standing(features_mm, "the virtual arm's artefact"), self, 0, count, 1, rng)
        return at_mm
