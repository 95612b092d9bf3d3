"""The point at given distances from others: the sum of the squared errors of the distances is least. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds
from ulna.geometry.settling import settle
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError

LEAST = 4
"""Points that determine another by their distances, if they are not on one plane; there are two of them then."""


@dataclass(frozen=True)
class FixedPoint:
    """Fitted to one set of points and distances, or to many: the leading axes are those of the points."""

    point_mm: F64
    """(..., 3)"""
    residuals_mm: F64
    """(..., N) distance from the point minus what it should be."""


def fit_point(points_mm: ArrayLike, distances_mm: ArrayLike, what: str = "point") -> FixedPoint:
    """(..., N, 3) points, N ≥ 4, and (..., N) distances → the point that is so far from them, by least squares.

    Started by the algebraic point (‖p‖² - d² = 2 p·c - ‖c‖², linear in c and ‖c‖²) and from both sides of the plane
    that the points are nearest to; Gauss–Newton on the distances ends it, and the best of the three is it. `what`: how
    messages call it. Raises UlnaInputError for fewer than four points, and for points on a line.
    """
    clouds = Clouds.of(points_mm, LEAST, what)
    _, axes = clouds.need(2, "on a line", "A point at known distances needs others that lie on no line: spread them.")
    distances = clouds.one_each(distances_mm) / clouds.size_mm[:, None]
    surface = _Distances(clouds.at, distances)
    everyone = np.ones(len(clouds.at), dtype=bool)
    best, cost = np.zeros((len(clouds.at), 3)), np.full(len(clouds.at), np.inf)
    height = np.sqrt(np.maximum((distances**2).mean(axis=1) - 1.0, 0.01))[:, None]
    for start in (_algebraic(clouds.at, distances), height * axes[:, 2], -height * axes[:, 2]):
        found, settled = settle(surface, start)
        sums = (surface.residuals(found, everyone) ** 2).sum(axis=1)
        better = settled & np.isfinite(found).all(axis=1) & (sums < cost)
        best[better], cost[better] = found[better], sums[better]
    if np.isinf(cost).any():
        k = int(np.argmax(np.isinf(cost)))
        raise UlnaInputError(
            f"{what}: {clouds.in_set(k)}no point is so far from the {clouds.count} points. Check the distances."
        )
    residuals = surface.residuals(best, everyone)
    return FixedPoint(
        clouds.vectors(clouds.mean_mm + clouds.size_mm[:, None] * best),
        clouds.each(clouds.size_mm[:, None] * residuals),
    )


def _algebraic(at: F64, distances: F64) -> F64:
    """(T, 3) points of the linear equations, of least norm where the points are on a plane."""
    rows = np.concatenate([2.0 * at, -np.ones((*at.shape[:2], 1))], axis=2)
    right = (at**2).sum(axis=2) - distances**2
    found: F64 = (np.linalg.pinv(rows, rcond=1e-9) @ right[..., None])[:, :3, 0]
    return found


@dataclass(frozen=True)
class _Distances:
    """A `Surface` of `settling`: distances from the point minus what they should be."""

    at: F64
    distances: F64

    def residuals(self, state: F64, own: Bool) -> F64:
        distance: F64 = np.linalg.norm(self.at[own] - state[:, None], axis=2)
        return distance - self.distances[own]

    def jacobian(self, state: F64, own: Bool) -> F64:
        away = self.at[own] - state[:, None]
        distance = np.linalg.norm(away, axis=2, keepdims=True)
        slope: F64 = -away / np.maximum(distance, np.finfo(np.float64).tiny)
        return slope

    def moved(self, state: F64, step: F64) -> F64:
        return state + step
