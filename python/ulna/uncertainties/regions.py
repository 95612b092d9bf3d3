"""Ellipsoidal coverage regions of vectors: JCGM 102:2011, 6.5.

In the units of y. The distribution of y is taken as normal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, Bool
from ulna.ground.quantiles import chi_squared


@dataclass(frozen=True)
class Ellipsoid:
    """Covers y with probability p: (η - centre)ᵀ U⁻¹ (η - centre) ≤ k² (JCGM 102 6.5)."""

    centre: F64
    """(m,)"""
    axes: F64
    """(m, m): unit directions in rows, the longest first."""
    half_lengths: F64
    """(m,): k times the standard uncertainty along each axis; 0 where y has none."""
    p: float
    k: float


def coverage_factor_of_region(p: float, m: int) -> float:
    """k_p of m normal coordinates: the root of the p-quantile of χ² with m degrees of freedom (JCGM 102 6.5)."""
    return math.sqrt(chi_squared(m, p))


def ellipsoid(y: F64, covariance: F64, p: float = 0.95) -> Ellipsoid:
    """y (m,), covariance (m, m) → the ellipsoid about y that covers with probability p."""
    k = coverage_factor_of_region(p, len(y))
    variances, directions = np.linalg.eigh(covariance)
    half_lengths = k * np.sqrt(np.maximum(variances[::-1], 0.0))
    return Ellipsoid(np.array(y, dtype=np.float64), directions.T[::-1].copy(), half_lengths, p, k)


def contains(ellipsoid: Ellipsoid, points: F64) -> Bool:
    """points (N, m) → (N,): whether each lies within. Along an axis of no length only the centre does."""
    along = np.abs((points - ellipsoid.centre) @ ellipsoid.axes.T)
    flat = ellipsoid.half_lengths == 0.0
    scaled = along[:, ~flat] / ellipsoid.half_lengths[~flat]
    inside: Bool = ((scaled**2).sum(axis=1) <= 1.0) & (along[:, flat] == 0.0).all(axis=1)
    return inside
