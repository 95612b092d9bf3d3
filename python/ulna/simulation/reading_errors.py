"""A virtual arm that touches things: readings with a known truth. Angles rad, lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import extra_of
from ulna.ground.arrays import F64

TRIES = 400
"""Random elbows and wrists to try for a point, so that one at the edge of the arm's travel is not given up."""
ROUNDS = 60
"""How often to draw places for an artefact before it is said to be too large for the arm."""


@dataclass(frozen=True)
class ReadingErrors:
    """How readings err that are taken with a virtual arm."""

    encoder_rad: F64
    """(n,) standard deviation of each encoder."""
    seat_mm: float
    """Standard deviation of a touch, per coordinate."""
    step_rad: F64 | None = None
    """(n,) what one count of each encoder is; None: it does not count in steps."""

    def read(self, q_rad: F64, rng: np.random.Generator) -> F64:
        """(N, n) angles as the encoders read them."""
        read: F64 = q_rad + self.encoder_rad * rng.standard_normal(q_rad.shape)
        return read if self.step_rad is None else np.round(read / self.step_rad) * self.step_rad


@dataclass(frozen=True)
class VirtualArm:
    """The true arm, how far its joints turn, and how its readings err."""

    arm: Arm
    travel_rad: F64
    """(n, 2) lowest and highest encoder angle."""
    errors: ReadingErrors

    def poses(self, count: int, rng: np.random.Generator) -> F64:
        """(count, n) encoder angles, uniform over the travel."""
        return rng.uniform(self.travel_rad[:, 0], self.travel_rad[:, 1], (count, self.arm.n))

    def touch(self, points_mm: F64, seed: int, rng: np.random.Generator) -> F64:
        """(N, n) readings with the ball in seats at (N, 3) points: seat noise, elbow at random, encoder noise.

        Raises ValueError for points out of reach.
        """
        beside = points_mm + self.errors.seat_mm * rng.standard_normal(points_mm.shape)
        q_rad, reached = self.arm.core.pose_for_points(beside, self.travel_rad, seed, tries=TRIES)
        if not reached.all():
            raise ValueError(f"{int((~reached).sum())} of {len(reached)} points are out of the virtual arm's reach")
        return self.errors.read(q_rad, rng)

    def places(self, features_mm: F64, count: int, seed: int, rng: np.random.Generator) -> F64:
        """(count, K, 3) where the (K, 3) features of an artefact are when it stands in random places and directions.

        Every feature is within the arm's reach and travel. Raises ValueError where that is not found.
        """
        found: list[F64] = []
        missing = count
        for _ in range(ROUNDS):
            tries = 4 * count + 20
            first = self.arm.tip(self.poses(tries, rng))
            at_mm = first[:, None] + (features_mm - features_mm[0]) @ turns(features_mm, tries, rng)
            _, reached = self.arm.core.pose_for_points(
                at_mm[:, 1:].reshape(-1, 3), self.travel_rad, seed, tries=TRIES // 40
            )
            found.append(at_mm[reached.reshape(tries, -1).all(axis=1)][:missing])
            missing -= len(found[-1])
            if not missing:
                return np.concatenate(found)
        raise ValueError(f"only {count - missing} of {count} places of the artefact are within the virtual arm's reach")


def as_drawn(
    arm: Arm, rng: np.random.Generator, wrong_rad: float, wrong_mm: float, wrong_twist_rad: float | None = None
) -> Arm:
    """What a drawing might give: zero offsets and lengths (the probe's too) off by up to so much, twists right angles
    (or off by up to wrong_twist_rad). Effects beyond geometry stay.

    The base frame is right: most ways of calibrating do not determine it.
    """
    wrong = arm.parameters.copy()
    for k, (name, unit) in enumerate(zip(arm.parameter_names, arm.parameter_units, strict=True)):
        if name in ("joint.1.theta0", "joint.1.d") or extra_of(name) is not None:
            continue
        twist = name.endswith(("alpha", "beta"))
        if twist and wrong_twist_rad is None:
            wrong[k] = np.round(wrong[k] / (np.pi / 2)) * (np.pi / 2)
        else:
            most = (wrong_twist_rad or 0.0) if twist else wrong_rad if unit == "rad" else wrong_mm
            wrong[k] += rng.uniform(-1.0, 1.0) * most
    return arm.with_parameters(wrong)


def turns(features_mm: F64, count: int, rng: np.random.Generator) -> F64:
    """(count, 3, 3) random rotations, rows the artefact's axes; features on its x axis need a direction only."""
    x = _unit(rng.standard_normal((count, 3)))
    if not (features_mm - features_mm[0])[:, 1:].any():
        return np.stack([x, np.zeros_like(x), np.zeros_like(x)], axis=1)
    y = rng.standard_normal((count, 3))
    y = _unit(y - (x * y).sum(axis=1, keepdims=True) * x)
    return np.stack([x, y, np.cross(x, y)], axis=1)


def _unit(vectors: F64) -> F64:
    lengths: F64 = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return lengths
