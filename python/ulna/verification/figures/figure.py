"""A figure: a number with its name, its formula and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Definition:
    """What a figure is."""

    name: str
    """As its source calls it: `P_Size.Sph.1x25:Tact.AArm`."""
    key: str
    """The short name, under which a limit is stated: `P_Size`."""
    formula: str
    """In words and signs; lengths in mm."""
    standard: str
    """Its source."""
    signed: bool
    """Whether it may be negative; what may not is limited from above alone."""
    unit: Literal["mm"] = "mm"

    def of(self, value: ArrayLike) -> Figure:
        """With a value of each test."""
        return Figure(self, np.asarray(value, dtype=np.float64))


@dataclass(frozen=True)
class Figure:
    """With its value: one number, or one of each of many tests."""

    definition: Definition
    value: F64
    """(...,) in the definition's unit."""


def points_of(points_mm: ArrayLike, axes: int, what: str) -> F64:
    """The points as an array of at least so many axes, the last one x, y, z. Raises UlnaInputError."""
    points = np.asarray(points_mm, dtype=np.float64)
    if points.ndim < axes or points.shape[-1] != 3:
        raise ValueError(f"{what}: expected an array with at least {axes} axes, the last x, y, z; got {points.shape}")
    if not np.isfinite(points).all():
        raise UlnaInputError(f"{what}: a coordinate is not a finite number; expected mm. Correct the points.")
    return points


def spread_of(deviation_mm: F64, what: str, least: int = 2) -> F64:
    """(..., n) → (...,) standard deviation about the mean, n - 1 in the denominator. Raises UlnaInputError."""
    if deviation_mm.shape[-1] < least:
        raise UlnaInputError(
            f"{what}: {deviation_mm.shape[-1]} value{'s' * (deviation_mm.shape[-1] != 1)}; a standard deviation needs "
            f"{least} at the least. Measure more."
        )
    return np.asarray(deviation_mm.std(axis=-1, ddof=1))
