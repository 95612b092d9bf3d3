"""Which of several models is chosen, by errors of readings left out.

Errors are compared by their ratios, group by group: one place that all models explain badly does not outweigh the
others. What errs by no more than one standard error of the difference more than the best cannot be told from it
(Breiman and others 1984). Of those the one with the most blocks is chosen, then the one that errs least: parameters of
a block that is not needed are known to be small, by a width that was learned, and do no harm, while a block that is
missing does. Nothing is chosen that errs more than geometry alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64

LEAST_MM = 1e-9
"""Smaller errors are rounding."""


@dataclass(frozen=True)
class Compared:
    """Models beside the best of them."""

    error_mm: F64
    """(m,) geometric mean over the groups."""
    worse: F64
    """(m,) by what part of the best one's error."""
    u_worse: F64
    """(m,) standard error of it."""
    best: int
    chosen: int


def compared(errors_mm: F64, blocks: Sequence[int]) -> Compared:
    """errors_mm (m, g) of each model and group, two or more groups, geometry alone first; blocks: how many each has."""
    logs = np.log(np.maximum(errors_mm, LEAST_MM))
    mean = logs.mean(axis=1)
    best = int(np.argmin(mean))
    apart = logs - logs[best]
    worse, u = apart.mean(axis=1), apart.std(axis=1, ddof=1) / np.sqrt(logs.shape[1])
    good = np.flatnonzero((worse <= u) & (mean <= mean[0])).tolist()
    chosen = min(good, key=lambda k: (-blocks[k], float(mean[k])))
    return Compared(np.exp(mean), np.expm1(worse), u * np.exp(worse), best, chosen)
