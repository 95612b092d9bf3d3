"""The least-squares circle in space: the sum of the squared distances of the points from the curve is least.

The squared distance is that in the plane of the circle and that from the plane, together (Shakarji 1998, J. Res. NIST
103, 633). Lengths mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds, Fitted
from ulna.geometry.settling import settle, solved
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError

LEAST = 3
"""Points that determine a circle."""
FARTHEST = 1e7
"""Radius over the extent of the points beyond which they do not tell the circle from a line."""


@dataclass(frozen=True)
class Circle(Fitted):
    """Fitted to one set of points, or to many: the leading axes are those of the points."""

    centre_mm: F64
    """(..., 3)"""
    normal: F64
    """(..., 3) unit vector, towards the side of the origin of coordinates."""
    radius_mm: F64
    """(...,)"""
    residuals_mm: F64
    """(..., N) distance from the axis minus the radius: positive is outside."""
    heights_mm: F64
    """(..., N) distance from the circle's plane, along the normal."""


def fit_circle(points_mm: ArrayLike, what: str = "circle") -> Circle:
    """(..., N, 3) points, N ≥ 3 → the least-squares circle of each set; `what`: how messages call it.

    The least-squares plane and an algebraic circle in it start it, Gauss–Newton on the distances ends it. Raises
    UlnaInputError for fewer than three points, for points on a line, and where no circle is nearest.
    """
    clouds = Clouds.of(points_mm, LEAST, what)
    extents, axes = clouds.need(2, "on a line", "A circle needs points that lie on no line: spread them around it.")
    surface = _Ring(clouds.at)
    state, settled = settle(surface, _started(clouds.at, axes))
    lost = ~settled | ~np.isfinite(state).all(axis=1) | (np.abs(state[:, 6]) > FARTHEST)
    if lost.any():
        k = int(np.argmax(lost))
        thin, wide = (clouds.size_mm[k] * extents[k, j] / np.sqrt(clouds.count) for j in (1, 0))
        raise UlnaInputError(
            f"{what}: {clouds.in_set(k)}no circle is nearest to the {clouds.count} points: they span {wide:.3g} mm "
            f"(rms) and are {thin:.3g} mm wide, too straight for their scatter. Spread them over more of the circle."
        )
    centre_mm = clouds.mean_mm + clouds.size_mm[:, None] * state[:, :3]
    turn = np.where((state[:, 3:6] * centre_mm).sum(axis=1) > 0.0, -1.0, 1.0)
    both = surface.residuals(state, np.ones(len(state), dtype=bool)) * clouds.size_mm[:, None]
    return Circle(
        clouds.vectors(centre_mm),
        clouds.vectors(state[:, 3:6] * turn[:, None]),
        clouds.numbers(clouds.size_mm * state[:, 6]),
        clouds.each(both[:, : clouds.count]),
        clouds.each(both[:, clouds.count :] * turn[:, None]),
    )


def _started(at: F64, axes: F64) -> F64:
    """(T, 7) centre, normal, radius: of an algebraic circle in the least-squares plane."""
    flat = at @ axes[:, :2].transpose(0, 2, 1)
    linear = np.concatenate([2.0 * flat, np.ones((*flat.shape[:2], 1))], axis=2)
    found = solved(linear, (flat**2).sum(axis=2))
    radius = np.sqrt(np.maximum(found[:, 2] + (found[:, :2] ** 2).sum(axis=1), 0.0))
    centre = np.einsum("tk,tkj->tj", found[:, :2], axes[:, :2])
    return np.concatenate([centre, axes[:, 2], radius[:, None]], axis=1)


@dataclass(frozen=True)
class _Ring:
    """A `Surface`: distances from the axis minus the radius, then heights above the plane."""

    at: F64

    def _parts(self, state: F64, own: Bool) -> tuple[F64, F64, F64]:
        away = self.at[own] - state[:, None, :3]
        height = np.einsum("tnk,tk->tn", away, state[:, 3:6])
        return away, height, away - height[..., None] * state[:, None, 3:6]

    def residuals(self, state: F64, own: Bool) -> F64:
        _, height, beside = self._parts(state, own)
        return np.concatenate([np.linalg.norm(beside, axis=2) - state[:, 6:], height], axis=1)

    def jacobian(self, state: F64, own: Bool) -> F64:
        away, height, beside = self._parts(state, own)
        distance = np.maximum(np.linalg.norm(beside, axis=2), np.finfo(np.float64).tiny)
        out = beside / distance[..., None]
        tilted = away @ _across(state[:, 3:6]).transpose(0, 2, 1)
        one = np.ones((*height.shape, 1))
        radial = np.concatenate([-out, -(height / distance)[..., None] * tilted, -one], axis=2)
        normal = np.broadcast_to(-state[:, None, 3:6], away.shape)
        axial = np.concatenate([normal, tilted, 0.0 * one], axis=2)
        return np.concatenate([radial, axial], axis=1)

    def moved(self, state: F64, step: F64) -> F64:
        normal = state[:, 3:6] + np.einsum("tk,tkj->tj", step[:, 3:5], _across(state[:, 3:6]))
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return np.concatenate([state[:, :3] + step[:, :3], normal, state[:, 6:] + step[:, 5:]], axis=1)


def _across(normal: F64) -> F64:
    """(T, 2, 3) two unit vectors across each (T, 3) normal."""
    least = np.eye(3)[np.abs(normal).argmin(axis=1)]
    first = np.cross(normal, least)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normal, first)], axis=1)
