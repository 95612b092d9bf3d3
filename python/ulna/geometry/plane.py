"""Least-squares planes: the sum of squared distances of the points from the plane is least."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]


@dataclass(frozen=True)
class Planes:
    """One for each set of points; leading axes as of the points."""

    middle_mm: F64
    """(..., 3) mean of the points: it lies in the plane."""
    normal: F64
    """(..., 3) of unit length, away from the origin: a plane in front of the base has its normal on the far side."""
    residuals_mm: F64
    """(..., N) distance of each point along the normal."""

    @property
    def form_mm(self) -> F64:
        """(...) largest less smallest distance: the flatness by least squares."""
        form: F64 = np.ptp(self.residuals_mm, axis=-1)
        return form


def planes(points_mm: F64) -> Planes:
    """(..., N, 3) → the plane of each set of three points or more that are on no line: the direction in which the
    centred points spread least, from their singular values."""
    middle = points_mm.mean(axis=-2)
    at = points_mm - middle[..., None, :]
    normal = np.linalg.svd(at, full_matrices=False)[2][..., 2, :]
    normal = normal * np.where((normal * middle).sum(axis=-1) < 0.0, -1.0, 1.0)[..., None]
    return Planes(middle, normal, (at @ normal[..., None])[..., 0])
