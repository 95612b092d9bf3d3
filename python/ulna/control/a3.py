"""Interval test, method A3 of NCSLI RP-1 (Establishment and Adjustment of Calibration Intervals): of so many
calibrations after one interval, how many were found in tolerance.

I1 = I0 · 10^((R̂ - R*) C), R̂ the share found in tolerance and R* that wanted; C, how surely they differ, is
1 - 2 P(X <= x) for a share too small and 1 - 2 P(X >= x) for one too large, X binomial of n with R*.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ulna.control.basis import Basis
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import fisher


@dataclass(frozen=True)
class IntervalTest:
    """Days."""

    basis: Basis
    in_tolerance: int
    target: float
    """R*."""
    reliability: float | None
    """R̂; None where there are too few calibrations, and then nothing below is known either."""
    bounds: tuple[float, float] | None
    """Of the true share, at `confidence` (Clopper and Pearson, 1934)."""
    surely: float | None
    """C, 0 to 1."""
    rejected: bool | None
    """Whether C is above `confidence`: the interval does not keep R*."""
    confidence: float
    calculated_days: float | None
    """By the formula."""
    interval_days: float | None
    """What to do: where the interval is rejected the calculated one, inside the bounds that were asked; else as now."""


def interval_test(
    in_tolerance: int,
    n: int,
    interval_days: float,
    target: float = 0.95,
    confidence: float = 0.95,
    bounds_days: tuple[float, float] = (0.0, math.inf),
    fewest: int = 4,
    span_days: float | None = None,
) -> IntervalTest:
    """Of n calibrations after about `interval_days` each.

    bounds_days: no shorter and no longer than these. span_days: over which the calibrations were, for the record.
    Raises UlnaInputError for what can be none of it.
    """
    if not (0 <= in_tolerance <= n and interval_days > 0.0 and 0.0 < target < 1.0 and 0.0 < confidence < 1.0):
        raise UlnaInputError(
            f"interval test: got {in_tolerance} of {n} in tolerance after {interval_days:g} days, target {target:g}, "
            f"confidence {confidence:g}; expected 0 to n of n, days above 0, shares between 0 and 1. Correct them."
        )
    rests_on = Basis("NCSLI RP-1 A3", n, max(fewest, 1), span_days)
    if rests_on.too_few:
        return IntervalTest(rests_on, in_tolerance, target, None, None, None, None, confidence, None, None)
    share = in_tolerance / n
    tail = range(in_tolerance + 1) if share <= target else range(in_tolerance, n + 1)
    surely = max(0.0, 1.0 - 2.0 * math.fsum(_binomial(k, n, target) for k in tail))
    calculated = interval_days * 10.0 ** ((share - target) * surely)
    rejected = surely > confidence
    least, most = bounds_days
    return IntervalTest(
        rests_on,
        in_tolerance,
        target,
        share,
        clopper_pearson(in_tolerance, n, confidence),
        surely,
        rejected,
        confidence,
        calculated,
        min(max(calculated, least), most) if rejected else interval_days,
    )


def clopper_pearson(x: int, n: int, confidence: float) -> tuple[float, float]:
    """Both ends of the interval that holds the probability of what came x of n times at least as surely as that."""
    p = 0.5 * (1.0 + confidence)
    low, high = 0.0, 1.0
    if x > 0:
        low = x / (x + (n - x + 1) * fisher(2.0 * (n - x + 1), 2.0 * x, p))
    if x < n:
        grown = (x + 1) * fisher(2.0 * (x + 1), 2.0 * (n - x), p)
        high = grown / (n - x + grown)
    return low, high


def _binomial(k: int, n: int, p: float) -> float:
    return math.comb(n, k) * p**k * (1.0 - p) ** (n - k)
