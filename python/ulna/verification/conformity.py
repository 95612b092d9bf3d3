"""Probabilities of conformity and risks of decisions, after JCGM 106:2012 (ISO/IEC Guide 98-4). Any unit, one for all.

Of a value η that was measured as y with standard uncertainty u, the difference normal and nothing else known of η:

========================================  ============================================================  ============
p_c, probability of conformity            Φ((T_U - y) / u) - Φ((T_L - y) / u)                           clause 7
R*_C, specific risk of the consumer       1 - p_c, of a y that is accepted                              clause 9
R*_P, specific risk of the producer       p_c, of a y that is rejected                                  clause 9
R_C, global risk of the consumer          ∫ over η outside [T_L, T_U] of g(η) P(accepted | η) dη        9.5
R_P, global risk of the producer          ∫ over η inside [T_L, T_U] of g(η) P(rejected | η) dη         9.5
========================================  ============================================================  ============

Φ is the standard normal distribution, T_L and T_U are what is tolerated, g is the density of what is made. Accepted is
|y| ≤ T - w, rejected |y| > T + w, with the guard band w of ISO 14253-1; between them nothing is decided. The binary
rules of JCGM 106 know no such third word: there rejected is what is not accepted, and its R_P is `withheld` here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ulna.ground.arrays import F64

Distribution = Literal["normal", "gamma"]

#: standard deviations of a normal variable beyond which nothing is left of it: Φ(-10) is 8e-24
_FAR = 10.0
#: standard deviations of what is made, above its mean: an exponential, the longest tail there is here, has 4e-18 there
_FAR_MADE = 40.0
#: part of the narrower of u and what is made's deviation that one panel of 16 nodes spans
_PANEL = 0.5
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


def phi(z: float) -> float:
    """Φ(z), exact in both tails; z may be infinite."""
    return 0.5 * math.erfc(-z / math.sqrt(2.0))


def probability(y: float, u: float, lower: float, upper: float) -> float:
    """p_c that a value measured as y lies in [lower, upper], one of which may be infinite; u ≥ 0, where 0 is exact."""
    if u == 0.0:
        return float(lower <= y <= upper)
    above, below = (y - upper) / u, (lower - y) / u
    # each tail is added by itself where it is small, so that a risk of 1e-20 is not the rest of a one
    return phi(-above) - phi(below) if above > 0.0 else 1.0 - phi(above) - phi(below)


def risk(y: float, u: float, lower: float, upper: float) -> float:
    """1 - p_c with all its digits: R*_C where y is accepted."""
    if u == 0.0:
        return float(not lower <= y <= upper)
    return phi((y - upper) / u) + phi((lower - y) / u)


@dataclass(frozen=True)
class Made:
    """The density g of what is made: normal, or of what cannot be negative a gamma distribution of the same mean and
    standard deviation, shape (mean / deviation)² (JCGM 106, 9.5, has its bearings so)."""

    mean: float
    deviation: float
    """> 0; of a gamma distribution not above the mean, so that its density is finite everywhere."""
    distribution: Distribution

    def density(self, eta: F64) -> F64:
        """g(η) of each η, (N,) → (N,)."""
        if self.distribution == "normal":
            z = (eta - self.mean) / self.deviation
            return np.asarray(np.exp(-0.5 * z * z) / (self.deviation * math.sqrt(2.0 * math.pi)))
        shape, rate = (self.mean / self.deviation) ** 2, self.mean / self.deviation**2
        x = rate * np.maximum(eta, 0.0)
        with np.errstate(divide="ignore"):
            power = (shape - 1.0) * np.log(x) if shape != 1.0 else np.zeros_like(x)
        return np.where(eta >= 0.0, rate * np.exp(power - x - math.lgamma(shape)), 0.0)

    @property
    def support(self) -> tuple[float, float]:
        """Where g is anything at all."""
        if self.distribution == "normal":
            return self.mean - _FAR * self.deviation, self.mean + _FAR * self.deviation
        return max(self.mean - _FAR_MADE * self.deviation, 0.0), self.mean + _FAR_MADE * self.deviation


@dataclass(frozen=True)
class GlobalRisk:
    """What becomes of one thing that is made, measured and decided; shares of all that are made."""

    consumer: float
    """R_C: it is accepted and does not conform."""
    producer: float
    """It is rejected and conforms."""
    withheld: float
    """It is not accepted and conforms: rejected or undecided. The R_P of a binary rule; without a guard band the same
    as `producer`."""
    undecided: float
    """Nothing is decided of it, whether it conforms or not."""


def global_risk(made: Made, u: float, limit: float, guard: float) -> GlobalRisk:
    """Of the rule: accepted where |y| ≤ limit - guard, rejected where |y| > limit + guard; conforming is |η| ≤ limit.

    u: standard uncertainty of y, ≥ 0; guard ≥ 0. Integrated by the rule of Gauss and Legendre, to some 1e-12.
    """
    accept, reject = limit - guard, limit + guard
    reach = _FAR * u
    outside = [(-max(accept, 0.0) - reach, -limit), (limit, max(accept, 0.0) + reach)]
    inside = [(-limit, min(-reject + reach, 0.0)), (max(reject - reach, 0.0), limit)]
    near = [(-limit, min(-accept + reach, 0.0)), (max(accept - reach, 0.0), limit)]
    band = [(-reject - reach, min(-accept + reach, 0.0)), (max(accept - reach, 0.0), reject + reach)]

    def over(spans: Sequence[tuple[float, float]], chance: Callable[[F64], F64]) -> float:
        return _integral(made, u or made.deviation, spans, chance)

    return GlobalRisk(
        consumer=over(outside, lambda eta: _within(eta, u, accept)),
        producer=over(inside, lambda eta: 1.0 - _within(eta, u, reject)),
        withheld=over(near, lambda eta: 1.0 - _within(eta, u, accept)),
        undecided=over(band, lambda eta: _within(eta, u, reject) - _within(eta, u, accept)),
    )


def _integral(made: Made, scale: float, spans: Sequence[tuple[float, float]], chance: Callable[[F64], F64]) -> float:
    """∫ g(η) chance(η) dη over the spans, in panels as narrow as the narrower of g and of `scale`, chance's, asks."""
    lowest, highest = made.support
    total = 0.0
    for low, high in spans:
        low, high = max(low, lowest), min(high, highest)
        if not low < high:
            continue
        count = math.ceil((high - low) / (_PANEL * min(scale, made.deviation)))
        edges = np.linspace(low, high, count + 1)
        half = 0.5 * np.diff(edges)
        eta = (edges[:-1] + half)[:, None] + half[:, None] * _NODES
        values = (made.density(eta.ravel()) * chance(eta.ravel())).reshape(eta.shape)
        total += float((half * (values @ _WEIGHTS)).sum())
    return min(total, 1.0)


def _within(eta: F64, u: float, bound: float) -> F64:
    """P(|y| ≤ bound | η) of each η; nothing is within a bound below 0."""
    if bound < 0.0:
        return np.zeros_like(eta)
    if u == 0.0:
        return (np.abs(eta) <= bound).astype(np.float64)
    return _phis((bound - eta) / u) - _phis((-bound - eta) / u)


def _phis(z: F64) -> F64:
    return np.array([phi(each) for each in z.tolist()])
