"""Postures in which an arm measures badly, in words: at a joint's stop, stretched, folded."""

from __future__ import annotations

import math

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.live.figures import Calibrated

NEAR_STOP_RAD = math.radians(2.0)
NEAR_STOP_MM = 5.0
"""So near to a joint's limit it is told; a touch is refused at the stop itself."""
FOLDED = 0.05
"""Least movement of the tip by its joints, beside that along the next direction: of random postures of the paper's arm
one in a hundred has less."""


def travel_of(arm: Arm) -> F64 | None:
    """(n, 2) how far joints turn; NaN of those without limits; None where none has."""
    each = [joint.limits_rad or (math.nan, math.nan) for joint in arm.joints]
    found = np.array(each, dtype=np.float64)
    return None if np.isnan(found).all() else found


def near_stops(arm: Arm, q_rad: F64) -> list[str]:
    """Joints near to their limits, or beyond, in words."""
    found = []
    for k, (joint, angle) in enumerate(zip(arm.joints, q_rad.tolist(), strict=True), start=1):
        if joint.limits_rad is None:
            continue
        left = min(angle - joint.limits_rad[0], joint.limits_rad[1] - angle)
        if left >= (NEAR_STOP_MM if joint.slides else NEAR_STOP_RAD):
            continue
        far = f"{abs(left):.1f} mm" if joint.slides else f"{math.degrees(abs(left)):.1f}°"
        found.append(
            worded("joint {joint} is {far} from its stop", joint=k, far=far)
            if left >= 0.0
            else worded("joint {joint} is {far} beyond its limit", joint=k, far=far)
        )
    return found


def folded(arm: Calibrated, q_rad: F64) -> list[str]:
    """Whether the arm is stretched or folded so that its joints hardly move the tip along one direction, in words."""
    if arm.arm.n < 3 or arm.arm.slides.any():
        return []
    directions, sizes, _ = np.linalg.svd(arm.by_angle(q_rad))
    if sizes[2] >= FOLDED * sizes[1]:
        return []
    along = ", ".join(f"{value:.2f}" for value in directions[:, 2])
    return [
        worded("stretched or folded: along ({along}) joints hardly move the tip; take another posture", along=along)
    ]
