"""Shares of intervals that hold the truth, and how well such a share is known."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

P = 0.95
"""Of every interval that is judged."""


@dataclass(frozen=True)
class Share:
    """Of intervals that hold."""

    held: int
    judged: int
    standard_error: float
    """Of the share; NaN where it cannot be told."""

    @property
    def share(self) -> float:
        """From 0 to 1; NaN where nothing was judged."""
        return self.held / self.judged if self.judged else math.nan

    def percent(self) -> str:
        """As a table has it."""
        if not self.judged:
            return "–"
        return f"{100 * self.share:.1f}&nbsp;±&nbsp;{100 * self.standard_error:.1f}"


def share_of_clusters(held: Sequence[int], judged: Sequence[int]) -> Share:
    """The share over all, from the numbers of each calibration (of so many intervals so many hold).

    What one calibration gets wrong is wrong in all of its intervals, so they are no independent trials: the standard
    error is that of a ratio over clusters (Cochran, Sampling Techniques, 1977, 2.11 with n large): s² = Σ(h_i - R m_i)²
    / (n (n-1) m̄²). Where each calibration has one interval, that is the binomial one.
    """
    h, m = np.asarray(held, dtype=np.float64), np.asarray(judged, dtype=np.float64)
    h, m = h[m > 0], m[m > 0]
    n = len(m)
    if n < 2:
        return Share(int(h.sum()), int(m.sum()), math.nan)
    left = h - h.sum() / m.sum() * m
    return Share(int(h.sum()), int(m.sum()), float(np.sqrt((left**2).sum() / (n * (n - 1))) / m.mean()))


def wilson(held: int, judged: int, p: float = P) -> tuple[float, float]:
    """Both ends of the score interval of a share (Wilson 1927, without correction for continuity); NaN of nothing."""
    if not judged:
        return math.nan, math.nan
    z2 = float(stats.norm.ppf(0.5 + 0.5 * p)) ** 2
    share = held / judged
    middle = (share + 0.5 * z2 / judged) / (1.0 + z2 / judged)
    half = math.sqrt(z2) / (1.0 + z2 / judged) * math.sqrt(share * (1.0 - share) / judged + 0.25 * z2 / judged**2)
    return middle - half, middle + half


def coverage_factor(degrees_of_freedom: float, p: float = P) -> float:
    """k of one number: Student's t, which is the normal one where the noise is known (infinite)."""
    return float(stats.t.ppf(0.5 + 0.5 * p, degrees_of_freedom))


def squared_radius(degrees_of_freedom: float, coordinates: int = 3, p: float = P) -> float:
    """k² of the ellipsoid that holds so many coordinates together: chi-squared (JCGM 102 6.5.2), or m F(m, ν) where a
    factor common to the whole covariance was estimated with ν degrees of freedom."""
    if math.isinf(degrees_of_freedom):
        return float(stats.chi2.ppf(p, coordinates))
    return coordinates * float(stats.f.ppf(p, coordinates, degrees_of_freedom))


def inside(errors: NDArray[np.float64], covariances: NDArray[np.float64], squared: float) -> NDArray[np.bool_]:
    """errors (N, 3) mm, covariances (N, 3, 3) mm² → (N,) whether eᵀ C⁻¹ e is within `squared`.

    A direction without variance holds no error beyond rounding: it counts as 1e-12 of the largest.
    """
    floor = 1e-12 * np.trace(covariances, axis1=1, axis2=2)
    solved = np.linalg.solve(covariances + floor[:, None, None] * np.eye(3), errors[:, :, None])[:, :, 0]
    found: NDArray[np.bool_] = np.einsum("ni,ni->n", errors, solved) <= squared
    return found
