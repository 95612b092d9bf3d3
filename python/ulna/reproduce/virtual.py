"""A virtual arm that touches things: readings with a known truth. Angles rad, lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ulna.model import Arm

F64 = NDArray[np.float64]

ENCODER_RAD = 5e-6
SEAT_MM = 0.008
"""Noise of the virtual experiments, standard deviations: of each encoder, and of a touch per coordinate."""

TRIES = 400
"""Random elbows and wrists to try for a point, so that one at the edge of the arm's travel is not given up."""
ROUNDS = 60
"""How often to draw places for an artefact before it is said to be too large for the arm."""


@dataclass(frozen=True)
class VirtualArm:
    """The true arm and how far its joints turn."""

    arm: Arm
    travel_rad: F64
    """(n, 2) lowest and highest encoder angle."""

    def poses(self, count: int, rng: np.random.Generator) -> F64:
        """(count, n) encoder angles, uniform over the travel."""
        return rng.uniform(self.travel_rad[:, 0], self.travel_rad[:, 1], (count, self.arm.n))

    def touch(self, points_mm: F64, seed: int, rng: np.random.Generator) -> F64:
        """(N, n) readings with the ball in seats at (N, 3) points: seat noise, elbow at random, encoder noise.

        Raises ValueError for points out of reach.
        """
        beside = points_mm + SEAT_MM * rng.standard_normal(points_mm.shape)
        q_rad, reached = self.arm.core.pose_for_points(beside, self.travel_rad, seed, tries=TRIES)
        if not reached.all():
            raise ValueError(f"{int((~reached).sum())} of {len(reached)} points are out of the virtual arm's reach")
        return q_rad + ENCODER_RAD * rng.standard_normal(q_rad.shape)

    def places(self, features_mm: F64, count: int, seed: int, rng: np.random.Generator) -> F64:
        """(count, K, 3) where the (K, 3) features of an artefact are when it stands in random places and directions.

        Every feature is within the arm's reach and travel. Raises ValueError where that is not found.
        """
        found: list[F64] = []
        missing = count
        for _ in range(ROUNDS):
            tries = 4 * count + 20
            first = self.arm.tip(self.poses(tries, rng))
            at_mm = first[:, None] + (features_mm - features_mm[0]) @ _turns(features_mm, tries, rng)
            _, reached = self.arm.core.pose_for_points(
                at_mm[:, 1:].reshape(-1, 3), self.travel_rad, seed, tries=TRIES // 40
            )
            found.append(at_mm[reached.reshape(tries, -1).all(axis=1)][:missing])
            missing -= len(found[-1])
            if not missing:
                return np.concatenate(found)
        raise ValueError(f"only {count - missing} of {count} places of the artefact are within the virtual arm's reach")


def as_drawn(arm: Arm, rng: np.random.Generator, wrong_rad: float, wrong_mm: float) -> Arm:
    """What a drawing might give: zero offsets and lengths (the probe's too) off by up to so much, twists right angles.

    The base frame is right: most ways of calibrating do not determine it.
    """
    wrong = arm.parameters.copy()
    for k, (name, unit) in enumerate(zip(arm.parameter_names, arm.parameter_units, strict=True)):
        if name.endswith("alpha"):
            wrong[k] = np.copysign(np.pi / 2, wrong[k])
        elif name not in ("joint.1.theta0", "joint.1.d"):
            wrong[k] += rng.uniform(-1.0, 1.0) * (wrong_rad if unit == "rad" else wrong_mm)
    return arm.with_parameters(wrong)


def _turns(features_mm: F64, count: int, rng: np.random.Generator) -> F64:
    """(count, 3, 3) rotations whose rows are the artefact's axes; features on its x axis need a direction only."""
    x = _unit(rng.standard_normal((count, 3)))
    if not (features_mm - features_mm[0])[:, 1:].any():
        return np.stack([x, np.zeros_like(x), np.zeros_like(x)], axis=1)
    y = rng.standard_normal((count, 3))
    y = _unit(y - (x * y).sum(axis=1, keepdims=True) * x)
    return np.stack([x, y, np.cross(x, y)], axis=1)


def _unit(vectors: F64) -> F64:
    lengths: F64 = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return lengths
