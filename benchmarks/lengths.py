"""What every peer is given: pairs of poses and the distances between their tips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

#: joint.1.theta0 and joint.1.d: no length depends on them, so every contender holds them
HELD = np.array([0, 3])
FREE = np.setdiff1d(np.arange(27), HELD)


@dataclass(frozen=True)
class Lengths:
    """Rows of two poses q, p (N, 7) in rad and the distance (N,) in mm between their tips."""

    q_rad: F64
    p_rad: F64
    length_mm: F64
