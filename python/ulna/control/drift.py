"""A straight line through figures over time: whether it slopes, where the next figure will be, and when it will meet
its limit.

Weighted least squares with weights 1/u²; Draper and Smith, Applied Regression Analysis (3rd ed., 1998), 1.4 and 9.2;
the scale is Birge's, Physical Review 40 (1932) 207. The slope is tested by Student's t of the scatter about the line,
whatever is stated of u: where u is too small, or is mostly of one standard that all figures share, a test against u
would be wrong as often as u is. So of figures that do not drift one in twenty is said to, whatever u is worth.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.control.basis import Basis, as_many, basis, figures, two_sided
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import chi_squared_beyond, fisher_beyond
from ulna.ground.worded import in_a_row, worded

FEWEST = 4
"""Figures: of three, one degree of freedom is left, and t is 12.7."""
SURE = 0.05
"""A slope, or a scatter, that chance makes less often is one."""


@dataclass(frozen=True)
class Line:
    """value(t) = middle + slope · (t - middle_days). Units of the figures, and days."""

    middle_days: float
    """The weighted mean of the times."""
    middle: float
    slope: float
    """For each day."""
    u_slope: float
    """Its standard uncertainty, by the scatter."""
    freedom: int
    """n - 2."""
    scale2: float
    """χ²/ν of the scatter; where no u was stated, its variance."""
    spread_days2: float
    """Σ w (t - middle)², w in 1/u²: the variance of the slope is 1 over this, times the scale."""
    total_weight: float
    u_next: float
    """Of a figure to come, before the scale: √(n / Σ w)."""
    last_days: float

    def at(self, days: float) -> float:
        """The line."""
        return self.middle + self.slope * (days - self.middle_days)

    def variance(self, days: float, scale2: float) -> float:
        """Of a new figure about the line: its own, and of the line there."""
        away = days - self.middle_days
        return scale2 * (self.u_next**2 + 1.0 / self.total_weight + away**2 / self.spread_days2)


@dataclass(frozen=True)
class Drift:
    """What figures say of how they drift."""

    basis: Basis
    line: Line | None
    """None where there are too few, and then nothing below is known either."""
    t: float | None
    p_value: float | None
    """How often figures that do not drift make as large a slope, up or down."""
    scatter_p: float | None
    """How often u makes as large a χ² about the line; None also where no u was stated."""
    confidence: float

    @property
    def drifts(self) -> bool | None:
        """Whether the slope is one, at 5 %; None where there are too few to say."""
        return None if self.p_value is None else self.p_value < SURE

    @property
    def explained(self) -> bool | None:
        """Whether u explains the scatter, at 5 %; None where no u was stated."""
        return None if self.scatter_p is None else self.scatter_p >= SURE

    @property
    def birge(self) -> float | None:
        """By which u is multiplied in the band: √(χ²/ν) where that is above 1, for u is the least that is known; None
        where there is no u."""
        return None if self.scatter_p is None or self.line is None else math.sqrt(max(self.line.scale2, 1.0))

    def band(self, days: float) -> tuple[float, float] | None:
        """Between which a figure of that day will be, with `confidence`; None where there are too few to say."""
        if self.line is None:
            return None
        half = self.k * math.sqrt(self.line.variance(days, self.scale2))
        return self.line.at(days) - half, self.line.at(days) + half

    @property
    def k(self) -> float:
        """Of the band: Student's t, n - 2 degrees of freedom."""
        return two_sided(self.basis.n - 2, self.confidence)

    @property
    def scale2(self) -> float:
        """Of variances in the band."""
        assert self.line is not None
        return self.line.scale2 if self.birge is None else self.birge**2

    @property
    def said(self) -> str:
        """In words."""
        if self.line is None or self.p_value is None:
            return worded("{basis}; nothing is said of drift.", basis=self.basis.said)
        found = worded("a slope") if self.drifts else worded("no slope that chance does not make")
        said = worded(
            "{found}: {slope} ± {u} a year (p = {p}, {basis}).",
            found=found,
            slope=f"{365.25 * self.line.slope:.3g}",
            u=f"{365.25 * self.line.u_slope:.2g}",
            p=f"{self.p_value:.2g}",
            basis=self.basis.said,
        )
        if self.explained is not False:
            return said
        scatter = worded(
            "The stated u does not explain the scatter: it is multiplied by {factor} (Birge).",
            factor=f"{self.birge:.2f}",
        )
        return in_a_row([said, scatter])


def drift(
    days: Sequence[float] | F64,
    values: Sequence[float] | F64,
    u: Sequence[float] | F64 | None = None,
    confidence: float = 0.95,
    fewest: int = FEWEST,
) -> Drift:
    """(N,) figures as found, (N,) when, in days since any day, and (N,) their standard uncertainties where known.

    fewest: figures that are asked for, 3 or more. Raises UlnaInputError for what are no numbers, for u of 0, and where
    all are of one day.
    """
    y = figures(values, "figures")
    when = as_many(days, y, "days")
    stated = np.ones(len(y)) if u is None else as_many(u, y, "u")
    if (stated <= 0.0).any():
        raise UlnaInputError(f"u: got {float(stated.min()):g}; expected standard uncertainties above 0. Correct them.")
    rests_on = basis("weighted straight line", len(y), max(fewest, 3), when)
    if rests_on.too_few:
        return Drift(rests_on, None, None, None, None, confidence)
    if not rests_on.span_days:
        raise UlnaInputError("days: all figures are of one day; expected figures over time. Correct the days.")
    line, chi2 = _fitted(when, y, stated)
    t = 0.0
    if line.slope != 0.0:
        t = line.slope / line.u_slope if line.u_slope > 0.0 else math.copysign(math.inf, line.slope)
    beyond = fisher_beyond(1.0, line.freedom, t * t) if math.isfinite(t) else 0.0
    scatter = None if u is None else chi_squared_beyond(line.freedom, chi2)
    return Drift(rests_on, line, t, beyond, scatter, confidence)


def _fitted(when: F64, y: F64, u: F64) -> tuple[Line, float]:
    w = 1.0 / u**2
    total = float(w.sum())
    middle_days, middle = float(w @ when) / total, float(w @ y) / total
    away = when - middle_days
    spread = float(w @ away**2)
    slope = float(w @ (away * (y - middle))) / spread
    chi2 = float(w @ (y - middle - slope * away) ** 2)
    freedom = len(y) - 2
    scale2 = chi2 / freedom
    u_next = math.sqrt(len(y) / total)
    line = Line(
        middle_days,
        middle,
        slope,
        math.sqrt(scale2 / spread),
        freedom,
        scale2,
        spread,
        total,
        u_next,
        float(when.max()),
    )
    return line, chi2
