"""Exponentially weighted moving averages: z_t = λ x_t + (1 - λ) z_(t-1), which see a small step sooner than single
figures do.

NIST/SEMATECH e-Handbook, 2.2.2.1.1, 6.3.2.4; Lucas and Saccucci, Technometrics 32 (1990) 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.control.basis import Basis, as_many, basis, figures
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError

FEWEST = 5
"""Figures of a baseline."""


@dataclass(frozen=True)
class Ewma:
    """The averages, their limits, and which are outside. Units are those of the figures."""

    basis: Basis
    weight: float
    """λ."""
    k: float
    centre: float | None
    """z_0; None where the baseline is too short, and then all below is empty."""
    averages: F64
    """(N,) z of each new figure."""
    half: F64
    """(N,) how far from the centre each may be."""
    outside: I64
    """Which of the new figures, from 0."""

    @property
    def in_control(self) -> bool | None:
        """None where the baseline is too short to say."""
        return None if self.basis.too_few else len(self.outside) == 0


def ewma(
    baseline: Sequence[float] | F64,
    new: Sequence[float] | F64,
    days: Sequence[float] | F64 | None = None,
    weight: float = 0.2,
    k: float = 3.0,
    fewest: int = FEWEST,
    exact: bool = True,
    of_the_mean: bool = False,
) -> Ewma:
    """(n,) figures of a time when all was well, (N,) new ones in order; days: (n,) when the baseline was.

    exact, of_the_mean: as `against`. Raises UlnaInputError for what are no numbers.
    """
    of, late = figures(baseline, "baseline"), figures(new, "figures")
    rests_on = basis("EWMA", len(of), max(fewest, 2), None if days is None else as_many(days, of, "days"))
    if rests_on.too_few:
        nothing = np.zeros(0)
        return Ewma(rests_on, weight, k, None, nothing, nothing, np.zeros(0, dtype=np.int64))
    return against(late, float(of.mean()), float(of.std(ddof=1)), rests_on, weight, k, exact, of_the_mean)


def against(
    new: F64,
    centre: float,
    s: float,
    rests_on: Basis,
    weight: float = 0.2,
    k: float = 3.0,
    exact: bool = True,
    of_the_mean: bool = False,
) -> Ewma:
    """(N,) figures against a known centre and s.

    exact: limits of the t-th average, k s √(λ/(2 - λ) (1 - (1 - λ)^(2 t))), which begin narrow; else those after long,
    k s √(λ/(2 - λ)). of_the_mean: the centre is itself a mean of n figures, so that (1 - (1 - λ)^t)²/n comes under the
    root: with k Student's t for n - 1, the t-th average is outside by chance as often as that t says.
    """
    if not 0.0 < weight <= 1.0 or k <= 0.0:
        raise UlnaInputError(f"EWMA: got weight {weight:g} and k {k:g}; expected 0 < weight <= 1 and k > 0.")
    averages = np.empty(len(new))
    z = centre
    for at, x in enumerate(new.tolist()):
        z = weight * x + (1.0 - weight) * z
        averages[at] = z
    count = np.arange(1, len(new) + 1)
    grown = 1.0 - (1.0 - weight) ** (2 * count) if exact else np.ones(len(new))
    own = (1.0 - (1.0 - weight) ** count) ** 2 / rests_on.n if of_the_mean else np.zeros(len(new))
    half = k * s * np.sqrt(weight / (2.0 - weight) * grown + own)
    return Ewma(rests_on, weight, k, centre, averages, half, np.flatnonzero(np.abs(averages - centre) > half))
