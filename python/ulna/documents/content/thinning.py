"""What is shown of very many readings: every n-th and all outliers, or runs of readings, never silently."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ulna.documents.languages.said import Said

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Bool = NDArray[np.bool_]


@dataclass(frozen=True)
class Shown:
    """Which of N are shown."""

    index: I64
    """Ascending."""
    step: int
    """Every how manieth; 1: all."""
    said: Said
    """What to write beside it."""


def shown(always: Bool, most: int) -> Shown:
    """Of N at most about `most`, evenly, and besides all of `always` (N,), the outliers."""
    count = len(always)
    step = max(math.ceil(count / most), 1)
    if step == 1:
        return Shown(np.arange(count), 1, Said("shown.all", {"count": count}))
    index = np.union1d(np.arange(0, count, step), np.flatnonzero(always))
    values = {"step": step, "count": count, "outliers": int(always.sum())}
    return Shown(index.astype(np.int64), step, Said("shown.thinned", values))


def shown_ranks(count: int, most: int, tails: int = 100) -> I64:
    """Of order statistics the `tails` lowest and highest all, where a distribution departs, and the middle evenly."""
    if count <= most:
        return np.arange(count)
    middle = np.linspace(tails, count - tails - 1, most - 2 * tails).round().astype(np.int64)
    return np.unique(np.concatenate([np.arange(tails), middle, np.arange(count - tails, count)]))


@dataclass(frozen=True)
class Runs:
    """Readings in a row, taken together."""

    step: int
    """Readings in a run; 1: each reading by itself."""
    first: I64
    """(R,) index of the first of each."""
    rms: F64
    largest: F64
    outlier: Bool
    """(R,) whether one of them is an outlier."""


def runs(value: F64, outlier: Bool, most: int) -> Runs:
    """(N,) → at most `most` runs of equally many, the last perhaps shorter."""
    count = len(value)
    step = max(math.ceil(count / most), 1)
    first = np.arange(0, count, step)
    size = np.diff(first, append=count)
    rms = np.sqrt(np.add.reduceat(value**2, first) / size) if count else np.zeros(0)
    largest = np.maximum.reduceat(np.abs(value), first) if count else np.zeros(0)
    marked = np.logical_or.reduceat(outlier, first) if count else np.zeros(0, dtype=bool)
    return Runs(step, first, rms, largest, marked)
