"""Where the first axis stands in the base frame."""

from __future__ import annotations

import numpy as np

from ulna.arm.data import ArmData
from ulna.arm.frames.rigid import pose, turn
from ulna.ground.arrays import F64


def t_base_first(arm: ArmData) -> F64:
    """(4, 4), mm: from the frame on the first axis to the base frame; the identity where nothing is said of it.

    `T(x, y, 0) · Rx(tilt_x) · Ry(tilt_y)`: see `ulna.arm.effects.base`.
    """
    own = arm.joints[0].effects
    x_mm, y_mm = own.base_offset_mm or (0.0, 0.0)
    x_rad, y_rad = own.base_tilt_rad or (0.0, 0.0)
    return pose(turn("x", x_rad) @ turn("y", y_rad), np.array([x_mm, y_mm, 0.0]))
