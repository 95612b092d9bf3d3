"""Shewhart's chart of single figures of a check standard: mean ± k s of a baseline.

NIST/SEMATECH e-Handbook of Statistical Methods, 2.2.2.1 and 2.3.5.2: k is t(1 - α/2, n - 1), and 3 of many.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.control.basis import Basis, as_many, basis, figures, two_sided
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError

BEYOND_3 = 0.0026997960632602
"""α of 3 s: how often a normal figure is beyond it."""
FEWEST = 5
"""Figures of a baseline: s of fewer is known to no better than half of itself."""
MANY = 100
"""Figures of a baseline from which k = 3 is used for t at `BEYOND_3`: they differ by less than 3 %."""


@dataclass(frozen=True)
class Shewhart:
    """Limits of a baseline, and what is outside them. Units are those of the figures."""

    basis: Basis
    centre: float | None
    """The mean of the baseline; None where it is too short, and then nothing below is known either."""
    s: float | None
    """Its standard deviation, n - 1 degrees of freedom."""
    k: float | None
    """Of the limits, in s."""
    lower: float | None
    upper: float | None
    outside: I64
    """Which of the new figures, from 0."""

    @property
    def in_control(self) -> bool | None:
        """None where the baseline is too short to say."""
        return None if self.basis.too_few else len(self.outside) == 0


def shewhart(
    baseline: Sequence[float] | F64,
    new: Sequence[float] | F64,
    days: Sequence[float] | F64 | None = None,
    alpha: float = BEYOND_3,
    fewest: int = FEWEST,
    of_the_mean: bool = False,
) -> Shewhart:
    """(n,) figures of a time when all was well, (N,) new ones; days: (n,) when the baseline was.

    alpha: how often a figure is outside by chance. of_the_mean: also the baseline's mean is known to s/√n only, so
    that the limits are k s √(1 + 1/n), of a prediction; the handbook leaves that out, and of short baselines more than
    alpha are then outside. Raises UlnaInputError for what are no numbers.
    """
    of, late = figures(baseline, "baseline"), figures(new, "figures")
    if not 0.0 < alpha < 1.0 or fewest < 2:
        raise UlnaInputError(f"limits: got alpha {alpha:g} of {fewest} figures; expected 0 < alpha < 1 of 2 or more.")
    n = len(of)
    rests_on = basis("Shewhart", n, fewest, None if days is None else as_many(days, of, "days"))
    if rests_on.too_few:
        return Shewhart(rests_on, None, None, None, None, None, np.zeros(0, dtype=np.int64))
    centre, s = float(of.mean()), float(of.std(ddof=1))
    k = 3.0 if alpha == BEYOND_3 and n >= MANY else two_sided(n - 1, 1.0 - alpha)
    half = k * s * (np.sqrt(1.0 + 1.0 / n) if of_the_mean else 1.0)
    outside = np.flatnonzero(np.abs(late - centre) > half)
    return Shewhart(rests_on, centre, s, k, centre - half, centre + half, outside)
