"""How readings err, how drawings do, and random directions. Angles rad, lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import extra_of
from ulna.ground.arrays import F64


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
        # theta0 of a joint that slides is no zero offset: it says how the links beside it are turned
        slid = name.endswith(".theta0") and arm.joints[int(name.split(".")[1]) - 1].slides
        twist = slid or name.endswith(("alpha", "beta"))
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
