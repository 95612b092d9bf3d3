"""What a statistic rests on, and figures as it takes them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import fisher_beyond, normal, student
from ulna.ground.worded import templates, worded

OVER = " over {days} days"
TOO_FEW = "too few: {count}, and at least {fewest} are needed"
TOO_FEW_OVER = "too few: {count}{over}, and at least {fewest} are needed"
OF = "of {count}"
OF_OVER = "of {count}{over}"
SAID = templates(OVER, TOO_FEW_OVER, TOO_FEW, OF_OVER, OF)
"""Templates of what a basis says, the narrower first."""


@dataclass(frozen=True)
class Basis:
    """Of which figures something is said. Where they are too few, nothing else is."""

    method: str
    n: int
    """Figures that it rests on."""
    fewest: int
    """Of them that the method asks for."""
    span_days: float | None
    """From the first to the last; None where it is not known when they were."""

    @property
    def too_few(self) -> bool:
        """Whether the method says nothing of them."""
        return self.n < self.fewest

    @property
    def said(self) -> str:
        """In words."""
        over = "" if self.span_days is None else worded(OVER, days=f"{self.span_days:.0f}")
        if self.too_few:
            if not over:
                return worded(TOO_FEW, count=self.n, fewest=self.fewest)
            return worded(TOO_FEW_OVER, count=self.n, over=over, fewest=self.fewest)
        return worded(OF_OVER, count=self.n, over=over) if over else worded(OF, count=self.n)


def basis(method: str, n: int, fewest: int, days: F64 | None = None) -> Basis:
    """days: (n,) when each figure was, any order, since any day; None where that is not known."""
    span = float(np.ptp(days)) if days is not None and len(days) else None
    return Basis(method, n, fewest, span)


def figures(values: Sequence[float] | F64, what: str) -> F64:
    """(N,) numbers, of any unit. Raises UlnaInputError for what is not a list of finite ones."""
    found = np.asarray(values, dtype=np.float64)
    if found.ndim != 1 or not np.isfinite(found).all():
        raise UlnaInputError(
            f"{what}: got {'a number that is not finite' if found.ndim == 1 else f'{found.ndim} dimensions'}; expected "
            "a list of finite numbers. Correct it."
        )
    return found


def as_many(values: Sequence[float] | F64, of: F64, what: str) -> F64:
    """The same, one for each of `of`, (N,). Raises UlnaInputError for another number of them."""
    found = figures(values, what)
    if len(found) != len(of):
        raise UlnaInputError(f"{what}: got {len(found)}, expected one for each of {len(of)} figures. Correct it.")
    return found


@lru_cache(maxsize=1024)
def two_sided(freedom: int, p: float) -> float:
    """The t that Student's, with 1 or more degrees of freedom, is inside of with probability p, on both sides."""
    return float(student(float(freedom), 0.5 * (1.0 + p)))


def normal_scores(values: F64, centre: float, s: float, n: int) -> F64:
    """(N,) new figures against the mean and the s > 0 of n → (N,) numbers that are standard normal where nothing has
    changed: Student's t of a prediction, (x - mean) / (s √(1 + 1/n)), by its probability."""
    t = (values - centre) / (s * np.sqrt(1.0 + 1.0 / n))
    beyond = [max(fisher_beyond(1.0, n - 1.0, each * each), 1e-15) for each in t.tolist()]
    return np.asarray(np.sign(t) * [normal(1.0 - 0.5 * p) for p in beyond], dtype=np.float64)
