"""Whether an arm errs elsewhere as its readings scatter in one place.

What a model does not explain is alike for touches that are near each other: readings of one standing share it, so that
there are fewer independent errors than readings, and parameters are known less well than their scatter says. Readings
of one standing left out show it. With rows J of a standing, what its placement explains taken off, residuals r of the
whole fit and H = J C Jᵀ (C of the parameters, for readings of unit variance), the fit to the others leaves
e = (I - H)⁻¹ r, and expects its covariance to be I + J C' Jᵀ = (I - H)⁻¹, C' without the standing. Along an eigenvector
of H with h < 1 the variance of e is then 1 + g² h / (1 - h), where g² is by what the parameters' covariance is too
small: the maximum of the likelihood of all standings says g², and its ratio to that of g = 1 whether chance does it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import ulna._core as _core
from ulna.ground.arrays import F64
from ulna.study.assembly import Assembled

MOST_EQUATIONS = 60_000
"""Beyond, a standing more or less shows nothing."""
MOST_PLACES = 300
"""Standings looked at; of more some, evenly through the study."""
ALONE = 0.9999
"""A direction of which a standing says more than this part is known from it alone: without it nothing is expected."""
SIGNIFICANT = 6.63
"""Twice the logarithm of the likelihoods' ratio that chance exceeds in one of a hundred."""
FEW = 3


@dataclass(frozen=True)
class BetweenPlaces:
    """What readings of one standing say of a fit to the others."""

    places: int
    """Standings that have something to say."""
    factor: float
    """By what the parameters' uncertainties are larger than the scatter of the readings makes them; 1 where chance
    explains it."""

    @property
    def few(self) -> bool:
        """Whether so few places show neither how an arm errs in another one, nor how it scatters there."""
        return self.places <= FEW


def between_places(assembled: Assembled, fitted: _core.Fitted) -> BetweenPlaces | None:
    """None where there is one place, nothing was fitted or is known of the scatter, or there are very many readings."""
    variance, covariance = fitted.variance, fitted.covariance
    if not covariance.size or not np.isfinite(covariance).all() or not variance > 0.0:
        return None
    if fitted.observations > MOST_EQUATIONS:
        return None
    rows, residuals, standing = _core.rows_of_fit(assembled.problem, assembled.hold, fitted)
    root = _root(covariance / variance)
    starts = np.flatnonzero(np.diff(standing, prepend=-1))
    ends = np.append(starts[1:], len(standing))
    if len(starts) < 2 or not root.shape[1]:
        return None
    some = np.unique(np.linspace(0, len(starts) - 1, min(len(starts), MOST_PLACES)).astype(int))
    ratios, squares, places = [], [], 0
    for k in some.tolist():
        own = slice(starts[k], ends[k])
        axes, sizes, _ = np.linalg.svd(rows[own] @ root, full_matrices=False)
        h = np.minimum(sizes**2, 1.0)
        told = (h < ALONE) & (h > 1e-12)
        places += bool(told.any())
        left = (axes.T @ residuals[own])[told] / (1.0 - h[told])
        ratios.append(h[told] / (1.0 - h[told]))
        squares.append(left**2 / variance)
    if places < 2:
        return None
    return BetweenPlaces(places, _factor(np.concatenate(ratios), np.concatenate(squares)))


def _factor(ratio: F64, square: F64) -> float:
    """√ of the g² at which squares (N,) of variance 1 + g² ratio are likeliest; 1 where chance explains that."""

    def likelihood(g2: F64) -> F64:
        variance = 1.0 + g2[:, None] * ratio
        found: F64 = -(np.log(variance) + square / variance).sum(axis=1)
        return found

    low, high = 0.0, 2.0 * np.log(1e3)
    for _ in range(6):  # ever finer, about the largest
        tried = np.exp(np.linspace(low, high, 41))
        best = int(np.argmax(likelihood(tried)))
        low, high = np.log(tried[max(best - 1, 0)]), np.log(tried[min(best + 1, 40)])
    g2 = np.array([1.0, tried[best]])
    one, more = likelihood(g2)
    return float(np.sqrt(g2[1])) if more - one > SIGNIFICANT else 1.0


def _root(covariance: F64) -> F64:
    """A matrix whose product with its transpose it is."""
    scale = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    scale[scale == 0.0] = 1.0
    sizes, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    kept = sizes > 1e-14 * max(float(sizes[-1]), 0.0)
    root: F64 = scale[:, None] * vectors[:, kept] * np.sqrt(sizes[kept])
    return root
