"""A chart of single figures: limits of a baseline, the weighted average, rules about figures in a row.

The baseline's mean is known to s/√n only, and its s to n - 1 degrees of freedom; all limits allow for both, so that the
newest figure, and its average, are each outside by chance as often as alpha says, of short baselines too
(tests/control/test_chart.py). Rules about rows find something in one of some twenty charts of what has not changed:
they are told, and decide nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ulna.control.basis import figures, normal_scores, two_sided
from ulna.control.ewma import Ewma, ewma
from ulna.control.runs import USUAL, Runs, runs
from ulna.control.shewhart import BEYOND_3, FEWEST, Shewhart, shewhart
from ulna.ground.arrays import F64

ROWS = USUAL[1:]
"""Rules about figures in a row; a single figure has limits of its own."""


@dataclass(frozen=True)
class Chart:
    """New figures against those of a time when all was well. Units are those of the figures."""

    limits: Shewhart
    averages: Ewma
    rows: Runs | None
    """None where the baseline is too short, does not scatter, or nothing came after it."""
    new: int
    """Figures after the baseline."""

    @property
    def beyond(self) -> bool:
        """Whether the newest figure is outside its limits."""
        return self.new > 0 and self.new - 1 in self.limits.outside

    @property
    def drifted(self) -> bool:
        """Whether its average is."""
        return self.new > 0 and self.new - 1 in self.averages.outside

    @property
    def in_control(self) -> bool | None:
        """Of the newest figure; None where the baseline is too short to say, or nothing came after it."""
        if self.limits.in_control is None or not self.new:
            return None
        return not (self.beyond or self.drifted)


def chart(
    baseline: Sequence[float] | F64,
    new: Sequence[float] | F64,
    days: Sequence[float] | F64 | None = None,
    alpha: float = BEYOND_3,
    fewest: int = FEWEST,
    weight: float = 0.2,
) -> Chart:
    """(n,) figures of a time when all was well, (N,) new ones in order; days: (n,) when the baseline was. alpha: how
    often a figure, and its average, is outside by chance; weight: λ of the average.

    Raises UlnaInputError for what are no numbers.
    """
    late = figures(new, "figures")
    limits = shewhart(baseline, late, days, alpha, fewest, of_the_mean=True)
    n = limits.basis.n
    k = two_sided(max(n - 1, 1), 1.0 - alpha)
    averages = ewma(baseline, late, days, weight, k, fewest, of_the_mean=True)
    if limits.centre is None or not limits.s or not len(late):
        return Chart(limits, averages, None, len(late))
    scores = normal_scores(late, limits.centre, limits.s, n)
    return Chart(limits, averages, runs(scores, 0.0, 1.0, ROWS), len(late))
