"""Stated intervals that held, and what a count of them says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ulna.calibration.likely import Cause
from ulna.ground.arrays import F64
from ulna.ground.binomial import wilson

P = 0.95
"""Probability with which intervals are to hold."""
LEAST = 20
"""Of fewer nothing is said of a factor."""
MUCH = 0.75
"""Intervals that would hold if they were this much of what they are, or less, are much too wide."""


@dataclass(frozen=True)
class Share:
    """How many of some stated intervals held."""

    count: int
    inside: int
    share: float
    low: float
    """Of the probability that one holds, with 95 % confidence (Wilson 1927)."""
    high: float
    factor: float | None = None
    """By what the stated uncertainties would have to be multiplied so that 95 of 100 hold; None of fewer than 20."""

    @property
    def too_small(self) -> bool:
        """Whether chance does not explain how few hold."""
        return self.high < P

    @property
    def too_large(self) -> bool:
        """Whether so many hold that chance does not explain it, by intervals that are much wider than they need be."""
        return self.low > P and self.factor is not None and self.factor < MUCH


@dataclass(frozen=True)
class Coverage:
    """Of readings that the fit had not seen."""

    points: Share | None
    """None where no feature has coordinates, or no uncertainty is known."""
    lengths: Share | None
    likely: list[Cause] = field(default_factory=list)
    """Where the intervals are too small: what may be why."""

    @property
    def shares(self) -> list[tuple[str, Share]]:
        """Those that there are, each with what it is of: "points", "lengths"."""
        both = (("points", self.points), ("lengths", self.lengths))
        return [(name, share) for name, share in both if share is not None]

    @property
    def too_small(self) -> dict[str, float]:
        """By what uncertainties of points or lengths are too small, beyond chance; a factor of 1 where they are
        too few to say it. Empty where they hold."""
        return {name: share.factor or 1.0 for name, share in self.shares if share.too_small}

    @property
    def too_large(self) -> float | None:
        """The larger part of what was stated that would do, where all intervals that there are are much too wide."""
        if not self.shares or not all(share.too_large for _, share in self.shares):
            return None
        return max(share.factor or 1.0 for _, share in self.shares)


@dataclass(frozen=True)
class Judged:
    """Errors over half widths of their stated 95 % intervals: inside are those of 1 and less."""

    points: F64
    lengths: F64
    errors_mm: F64 = field(default_factory=lambda: np.zeros((0, 2)))
    """(N, 2) of each length its error and the standard uncertainty of that, mm."""

    def coverage(self, likely: Sequence[Cause] = ()) -> Coverage:
        """Of all of them; likely: why they may be too small, said where they are."""
        found = Coverage(_share(self.points), _share(self.lengths))
        return replace(found, likely=list(likely)) if found.too_small else found

    @staticmethod
    def together(parts: Sequence[Judged]) -> Judged:
        """Of several fits."""
        nothing = np.zeros(0)
        return Judged(
            np.concatenate([nothing, *(part.points for part in parts)]),
            np.concatenate([nothing, *(part.lengths for part in parts)]),
            np.concatenate([np.zeros((0, 2)), *(part.errors_mm for part in parts)]),
        )


def _share(ratios: F64) -> Share | None:
    if not len(ratios):
        return None
    inside = int((ratios <= 1.0).sum())
    low, high = wilson(inside, len(ratios), P)
    factor = float(np.quantile(ratios, P)) if len(ratios) >= LEAST else None
    return Share(len(ratios), inside, inside / len(ratios), low, high, factor)
