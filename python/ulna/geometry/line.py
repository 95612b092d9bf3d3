"""The least-squares line in space: the sum of the squared distances of the points from it is least. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds
from ulna.ground.arrays import F64

LEAST = 2
"""Points that determine a line."""


@dataclass(frozen=True)
class Line:
    """Fitted to one set of points, or to many: the leading axes are those of the points."""

    point_mm: F64
    """(..., 3) on it: the mean of the points."""
    direction: F64
    """(..., 3) unit vector, from the first point towards the last."""
    residuals_mm: F64
    """(..., N) distance from the line, never negative: in space there is no side."""

    @property
    def form_mm(self) -> F64:
        """(...,) diameter of the smallest cylinder about this line that holds the points."""
        return np.asarray(2.0 * self.residuals_mm.max(axis=-1))


def fit_line(points_mm: ArrayLike, what: str = "line") -> Line:
    """(..., N, 3) points, N ≥ 2 → the least-squares line of each set; `what`: how messages call it.

    Its direction is that of the largest extent about the mean (singular value decomposition). Raises UlnaInputError for
    fewer than two points and for points that are all one.
    """
    clouds = Clouds.of(points_mm, LEAST, what)
    _, axes = clouds.need(1, "one and the same", "A line needs two places at the least.")
    direction = axes[:, 0]
    onward = ((clouds.at[:, -1] - clouds.at[:, 0]) * direction).sum(axis=1)
    direction = direction * np.where(onward < 0.0, -1.0, 1.0)[:, None]
    beside = clouds.at - np.einsum("tnk,tk->tn", clouds.at, direction)[..., None] * direction[:, None]
    residuals = clouds.size_mm[:, None] * np.linalg.norm(beside, axis=2)
    return Line(clouds.vectors(clouds.mean_mm), clouds.vectors(direction), clouds.each(residuals))
