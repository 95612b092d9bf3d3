"""Least-squares spheres: the sum of squared distances of the points from the surface is least."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

ROUNDS = 50
"""Gauss–Newton steps at the most; each is quadratic near the end."""


@dataclass(frozen=True)
class Spheres:
    """One for each set of points; leading axes as of the points."""

    centre_mm: F64
    """(..., 3)"""
    radius_mm: F64
    """(...)"""
    residuals_mm: F64
    """(..., N) distance of each point from the centre, less the radius."""

    @property
    def form_mm(self) -> F64:
        """(...) largest less smallest distance from the centre."""
        form: F64 = np.ptp(self.residuals_mm, axis=-1)
        return form


def spheres(points_mm: F64) -> Spheres:
    """(..., N, 3) → the sphere of each set of four points or more that are in no plane.

    An algebraic start (linear in centre and squared radius), then Gauss–Newton on the distances, by QR of centred
    points, so that a small cap loses no digits twice.
    """
    leading = points_mm.shape[:-2]
    points = points_mm.reshape(-1, *points_mm.shape[-2:])
    middle = points.mean(axis=1, keepdims=True)
    at = points - middle
    linear = np.concatenate([2.0 * at, np.ones((*at.shape[:2], 1))], axis=2)
    found = _solved(linear, (at**2).sum(axis=2))
    centre = found[:, :3]
    radius = np.sqrt(np.maximum(found[:, 3] + (centre**2).sum(axis=1), 0.0))
    for _ in range(ROUNDS):
        away = at - centre[:, None]
        distance = np.linalg.norm(away, axis=2)
        jacobian = np.concatenate([-away / distance[:, :, None], -np.ones((*distance.shape, 1))], axis=2)
        step = _solved(jacobian, radius[:, None] - distance)
        centre, radius = centre + step[:, :3], radius + step[:, 3]
        if np.abs(step).max() < 1e-12 * radius.max():
            break
    residuals = np.linalg.norm(at - centre[:, None], axis=2) - radius[:, None]
    whole = (centre + middle[:, 0]).reshape(*leading, 3)
    return Spheres(whole, radius.reshape(leading), residuals.reshape(*leading, -1))


def _solved(jacobian: F64, right: F64) -> F64:
    """(T, k) least squares of (T, N, k) rows."""
    q, r = np.linalg.qr(jacobian)
    solution: F64 = np.linalg.solve(r, np.einsum("tnk,tn->tk", q, right)[..., None])[..., 0]
    return solution
