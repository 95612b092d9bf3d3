"""The least-squares plane: the sum of the squared distances of the points from it is least. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds, Fitted
from ulna.ground.arrays import F64

LEAST = 3
"""Points that determine a plane."""


@dataclass(frozen=True)
class Plane(Fitted):
    """Fitted to one set of points, or to many: the leading axes are those of the points."""

    point_mm: F64
    """(..., 3) on it: the mean of the points."""
    normal: F64
    """(..., 3) unit vector, towards the side of the origin of coordinates (of an arm: its base)."""
    residuals_mm: F64
    """(..., N) distance along the normal."""

    def distance_mm(self, point_mm: ArrayLike) -> F64:
        """(..., 3) points → (...,): signed, along the normal."""
        away: F64 = ((np.asarray(point_mm, dtype=np.float64) - self.point_mm) * self.normal).sum(axis=-1)
        return away


def fit_plane(points_mm: ArrayLike, what: str = "plane") -> Plane:
    """(..., N, 3) points, N ≥ 3 → the least-squares plane of each set; `what`: how messages call it.

    The normal is the direction of least extent about the mean (singular value decomposition). Raises UlnaInputError for
    fewer than three points and for points on a line.
    """
    clouds = Clouds.of(points_mm, LEAST, what)
    _, axes = clouds.need(2, "on a line", "A plane needs points that lie on no line: spread them over the face.")
    normal = axes[:, 2]
    side = (normal * clouds.mean_mm).sum(axis=1)
    normal = normal * np.where(side > 0.0, -1.0, 1.0)[:, None]
    residuals = clouds.size_mm[:, None] * np.einsum("tnk,tk->tn", clouds.at, normal)
    return Plane(clouds.vectors(clouds.mean_mm), clouds.vectors(normal), clouds.each(residuals))
