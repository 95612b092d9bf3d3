"""The least-squares sphere: the sum of the squared distances of the points from its surface is least. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds, Fitted
from ulna.geometry.settling import settle, solved
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError

LEAST = 4
"""Points that determine a sphere."""
FARTHEST = 1e7
"""Radius over the extent of the points beyond which they do not tell the sphere from a plane."""


@dataclass(frozen=True)
class Sphere(Fitted):
    """Fitted to one set of points, or to many: the leading axes are those of the points."""

    centre_mm: F64
    """(..., 3)"""
    radius_mm: F64
    """(...,)"""
    residuals_mm: F64
    """(..., N) distance from the centre minus the radius (and the offset): positive is outside."""


def fit_sphere(points_mm: ArrayLike, what: str = "sphere", offsets_mm: ArrayLike = 0.0) -> Sphere:
    """(..., N, 3) points, N ≥ 4 → the least-squares sphere of each set; `what`: how messages call it.

    offsets_mm, a number or (..., N): how much farther out than the surface each point is, such as a ball's radius.

    An algebraic fit starts it (linear in centre and radius² - centre²; Kåsa 1976), Gauss–Newton on the distances ends
    it. Raises UlnaInputError for fewer than four points, for points on a plane, and where no sphere is nearest.
    """
    clouds = Clouds.of(points_mm, LEAST, what)
    advice = "A sphere needs points that lie on no plane: spread them over the ball, or check the file."
    extents, _ = clouds.need(3, "on a plane", advice)
    offsets = clouds.one_each(offsets_mm) / clouds.size_mm[:, None]
    surface = _Ball(clouds.at, offsets)
    state, settled = settle(surface, _started(clouds.at, offsets))
    lost = ~settled | ~np.isfinite(state).all(axis=1) | (np.abs(state[:, 3]) > FARTHEST)
    if lost.any():
        k = int(np.argmax(lost))
        flat, wide = (clouds.size_mm[k] * extents[k, j] / np.sqrt(clouds.count) for j in (2, 0))
        raise UlnaInputError(
            f"{what}: {clouds.in_set(k)}no sphere is nearest to the {clouds.count} points: they span {wide:.3g} mm "
            f"(rms) and are {flat:.3g} mm thick, too flat for their scatter. Spread the points over more of the ball."
        )
    everyone = np.ones(len(state), dtype=bool)
    return Sphere(
        clouds.vectors(clouds.mean_mm + clouds.size_mm[:, None] * state[:, :3]),
        clouds.numbers(clouds.size_mm * state[:, 3]),
        clouds.each(clouds.size_mm[:, None] * surface.residuals(state, everyone)),
    )


def _started(at: F64, offsets: F64) -> F64:
    """(T, 4) centre and radius of the algebraic fit."""
    linear = np.concatenate([2.0 * at, np.ones((*at.shape[:2], 1))], axis=2)
    found = solved(linear, (at**2).sum(axis=2))
    centre = found[:, :3]
    radius = np.sqrt(np.maximum(found[:, 3] + (centre**2).sum(axis=1), 0.0))
    return np.concatenate([centre, radius[:, None] - offsets.mean(axis=1, keepdims=True)], axis=1)


@dataclass(frozen=True)
class _Ball:
    """A `Surface`: distances from the centre minus the radius and what each point is farther out."""

    at: F64
    offsets: F64

    def residuals(self, state: F64, own: Bool) -> F64:
        away = self.at[own] - state[:, None, :3]
        distance: F64 = np.linalg.norm(away, axis=2)
        return distance - state[:, 3:] - self.offsets[own]

    def jacobian(self, state: F64, own: Bool) -> F64:
        away = self.at[own] - state[:, None, :3]
        distance = np.linalg.norm(away, axis=2)
        unit = away / np.maximum(distance, np.finfo(np.float64).tiny)[:, :, None]
        return np.concatenate([-unit, -np.ones((*distance.shape, 1))], axis=2)

    def moved(self, state: F64, step: F64) -> F64:
        return state + step
