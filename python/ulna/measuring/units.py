"""Units of the angles that are measured with."""

from __future__ import annotations

import math

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest

ANGLES = ("rad", "deg", "counts")


def rad_per(arm: Arm, angle: str) -> F64:
    """(n,) rad in a unit of the angles. Raises UlnaInputError for one that is none, or counts of nobody knows what."""
    if angle not in ANGLES:
        raise UlnaInputError(f"measure: angle '{angle}'; expected rad, deg or counts.{nearest(angle, ANGLES)}")
    if angle != "counts":
        return np.full(arm.n, 1.0 if angle == "rad" else math.pi / 180.0)
    for k, joint in enumerate(arm.joints, start=1):
        if joint.counts_per_turn is None:
            raise UlnaInputError(
                f"arm '{arm.name}': key 'joint.{k}.counts_per_turn' is missing, which readings in counts need. Add it "
                "to the arm file."
            )
    return np.array([2.0 * math.pi / (joint.counts_per_turn or math.nan) for joint in arm.joints])
