"""Poses to draw an arm in."""

from __future__ import annotations

import math
import re

import numpy as np

from ulna.arm.data import ArmData
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


def start_pose(arm: ArmData) -> F64:
    """(n,) rad: every encoder at 0, or in the middle of its limits where 0 is beyond them."""
    limits = [joint.limits_rad or (0.0, 0.0) for joint in arm.joints]
    return np.array([0.0 if low <= 0.0 <= high else (low + high) / 2.0 for low, high in limits])


def typical(poses_rad: F64) -> int:
    """Which of (N, n) poses is nearest to the median of all, joint by joint; angles as they are, N at least 1."""
    spread = np.maximum(np.ptp(poses_rad, axis=0), 1e-9)
    off = (poses_rad - np.median(poses_rad, axis=0)) / spread
    return int(np.argmin(np.sum(off**2, axis=1)))


def pose_of(text: str, arm: ArmData) -> F64:
    """(n,) rad of encoder angles in degrees, as people write them: "0, 30, -45". Raises UlnaInputError."""
    words = [each for each in re.split(r"[\s,;]+", text.strip()) if each]
    for k, word in enumerate(words, start=1):
        if not _is_angle(word):
            raise UlnaInputError(
                f"option --pose: got '{word}' as angle {k}; expected degrees with a decimal point, such as "
                f'"{_example(arm)}". Correct it.'
            )
    if len(words) != arm.n:
        raise UlnaInputError(
            f"option --pose: got {len(words)} angles ({text}), expected {arm.n}, one for each joint of arm "
            f"'{arm.name}', in degrees: \"{_example(arm)}\". Correct it."
        )
    return np.radians([float(word) for word in words])


def _is_angle(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def _example(arm: ArmData) -> str:
    return ",".join(("0", "30", "-45")[k % 3] for k in range(arm.n))
