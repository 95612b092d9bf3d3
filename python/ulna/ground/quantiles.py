"""Quantiles of the normal, Student's t, chi-squared and F distributions, for coverage factors and tests.

Five functions of SciPy, which is five times as large as all of Ulna and is needed for nothing else that everybody uses:
here from the continued fraction of the incomplete beta function (Abramowitz and Stegun 26.5.8, by Lentz's method) and
the series of the incomplete gamma function (6.5.29), solved by Newton's method inside a bracket. They agree with SciPy
to some ten digits; a test says so.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ulna.ground.arrays import F64

_MOST_TERMS = 20_000
_MANY_DEGREES = 1000.0
"""Of freedom: from here on the expansion in their reciprocal has all digits."""
_SMALLEST = 1e-300


def normal(p: float) -> float:
    """The value that a standard normal variable stays below with probability p, 0 < p < 1 (Wichura 1988)."""
    from statistics import NormalDist  # loads decimal and fractions, while most fits ask for no quantile

    return NormalDist().inv_cdf(p)


def normals(p: NDArray[np.floating]) -> F64:
    """The same of each p, (N,)."""
    from statistics import NormalDist

    inverse = NormalDist().inv_cdf
    return np.array([inverse(each) for each in p.tolist()])


def student(freedom: F64 | float, p: float) -> F64:
    """The value that Student's t with `freedom` degrees of freedom, (…), stays below with probability p, 0 < p < 1;
    (…), NaN where there is none."""
    v = np.atleast_1d(np.asarray(freedom, dtype=np.float64))
    z = normal(p)
    if z < 0.0:
        return -student(freedom, 1.0 - p)
    found = np.where(v > 0.0, _nearly_normal(np.where(v > 0.0, v, np.nan), z), np.nan)
    few = (v > 0.0) & (v < _MANY_DEGREES)
    if few.any() and z > 0.0:
        some = v[few]

        constant = _lgamma(0.5 * (some + 1.0)) - _lgamma(0.5 * some) - 0.5 * np.log(some * math.pi)

        def tail(t: F64) -> tuple[F64, F64]:  # as a logarithm, which is nearly straight over log t
            square = some + t * t
            above = 0.5 * _beta(0.5 * some, np.full_like(some, 0.5), some / square, t * t / square)
            density = np.exp(constant - 0.5 * (some + 1.0) * np.log1p(t * t / some))
            return math.log(1.0 - p) - np.log(above), density / above

        found[few] = _solved(tail, np.maximum(found[few], z))
    return found.reshape(np.shape(freedom))


def _nearly_normal(v: F64, z: float) -> F64:
    """Student's t by the normal quantile z and powers of 1/v (Abramowitz and Stegun 26.7.5)."""
    z2 = z * z
    terms = (
        z,
        z * (z2 + 1) / 4,
        z * ((5 * z2 + 16) * z2 + 3) / 96,
        z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384,
        z * ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / 92160,
    )
    return np.asarray(sum(term / v**power for power, term in enumerate(terms)), dtype=np.float64)


def fisher(numerator: float, denominator: float, p: float) -> float:
    """The value that F with these degrees of freedom stays below with probability p, 0 < p < 1; NaN where
    there is none."""
    if not denominator > 0.0:
        return math.nan
    a, b = np.array([0.5 * numerator]), np.array([0.5 * denominator])
    constant = _lgamma(a + b) - _lgamma(a) - _lgamma(b) + a * math.log(numerator / denominator)

    def below(x: F64) -> tuple[F64, F64]:
        over = numerator * x + denominator
        density = np.exp(constant + (a - 1.0) * np.log(x) - (a + b) * np.log1p(numerator / denominator * x))
        return _beta(a, b, numerator * x / over, denominator / over) - p, density

    return float(_solved(below, np.ones(1))[0])


def chi_squared(freedom: float, p: float) -> float:
    """The value that chi-squared with `freedom` degrees of freedom, > 0, stays below with probability p, 0 < p < 1."""
    a = 0.5 * freedom

    def below(x: F64) -> tuple[F64, F64]:
        half = 0.5 * x
        density = 0.5 * np.exp((a - 1.0) * np.log(half) - half - math.lgamma(a))
        return np.array([_gamma(a, float(half[0])) - p]), density

    return float(_solved(below, np.array([freedom]))[0])


def chi_squared_beyond(freedom: int, value: float) -> float:
    """How often chi-squared with a whole number of degrees of freedom, > 0, is above a value >= 0 (Abramowitz and
    Stegun 26.4.4 and 26.4.5)."""
    h = 0.5 * value
    if h <= 0.0:
        return 1.0
    first = 0.0 if freedom % 2 == 0 else 0.5
    powers = [first + k for k in range((freedom - freedom % 2) // 2)]
    total = math.fsum(math.exp(power * math.log(h) - h - math.lgamma(power + 1.0)) for power in powers)
    return min(1.0, total + (math.erfc(math.sqrt(h)) if freedom % 2 else 0.0))


def fisher_beyond(numerator: float, denominator: float, value: float) -> float:
    """How often F with these degrees of freedom, > 0, is above a value >= 0."""
    over = numerator * value + denominator
    parts = (0.5 * denominator, 0.5 * numerator, denominator / over, numerator * value / over)
    return float(_beta(*(np.array([part]) for part in parts))[0])


def _solved(error: Callable[[F64], tuple[F64, F64]], start: F64) -> F64:
    """Where an error that grows with x > 0 is zero, (N,): Newton's steps of log x, or halves of a bracket.

    error: x, (N,) → its error and the slope of that.
    """
    at = np.log(start)
    low, high = np.full_like(at, -600.0), np.full_like(at, 600.0)
    for _ in range(200):
        x = np.exp(at)
        wrong, slope = error(x)
        low, high = np.where(wrong < 0.0, at, low), np.where(wrong < 0.0, high, at)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            new = at - wrong / (slope * x)
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        near = np.abs(new - at) <= 1e-9  # the next step would be its square
        at = new
        if near.all():
            break
    return np.exp(at)


def _beta(a: F64, b: F64, x: F64, y: F64) -> F64:
    """The regularised incomplete beta function I_x(a, b); y is 1 - x, with all its digits; all (N,)."""
    swapped = x > (a + 1.0) / (a + b + 2.0)
    p, q = np.where(swapped, b, a), np.where(swapped, a, b)
    u, w = np.where(swapped, y, x), np.where(swapped, x, y)
    u, w = np.maximum(u, _SMALLEST), np.maximum(w, _SMALLEST)
    front = np.exp(_lgamma(p + q) - _lgamma(p) - _lgamma(q) + p * np.log(u) + q * np.log(w)) / p
    part = front * _fraction(p, q, u)
    found: F64 = np.where(swapped, 1.0 - part, part)
    return found


def _fraction(a: F64, b: F64, x: F64) -> F64:
    """The continued fraction, forwards (Lentz 1976, as Thompson and Barnett 1986 changed it)."""
    c = np.ones_like(x)
    d = 1.0 / (1.0 - (a + b) * x / (a + 1.0))
    value = d
    for m in range(1, _MOST_TERMS):
        for factor in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            d, c = 1.0 + factor * d, 1.0 + factor / c
            d, c = 1.0 / np.where(np.abs(d) < _SMALLEST, _SMALLEST, d), np.where(np.abs(c) < _SMALLEST, _SMALLEST, c)
            value = value * d * c
        if bool((np.abs(d * c - 1.0) < 2e-15).all()):
            break
    return value


def _gamma(a: float, x: float) -> float:
    """The regularised incomplete gamma function P(a, x); its series has no minus sign."""
    term = total = 1.0 / a
    for n in range(1, _MOST_TERMS):
        term *= x / (a + n)
        total += term
        if term < total * 1e-17:
            break
    return total * math.exp(a * math.log(x) - x - math.lgamma(a)) if x > 0.0 else 0.0


def _lgamma(x: F64) -> F64:
    return np.array([math.lgamma(each) for each in x.tolist()])
