"""Sets of points as they come to a fit: checked, centred, scaled to size one. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: extents of a set along its principal directions, over the largest, below which it has no extent there: what rounding
#: leaves of points with coordinates a thousand times their distance apart
FLAT = 1e-11


@dataclass(frozen=True)
class Clouds:
    """T sets of N points each."""

    at: F64
    """(T, N, 3) about the mean of each set, over `size_mm`."""
    mean_mm: F64
    """(T, 3)"""
    size_mm: F64
    """(T,) root of the mean of the squared distances from the mean; 1 where all points are one."""
    shape: tuple[int, ...]
    """The leading axes that came in."""
    what: str
    """How messages call a set."""

    @classmethod
    def of(cls, points_mm: ArrayLike, least: int, what: str) -> Clouds:
        """From (..., N, 3). Raises UlnaInputError for fewer points than `least`, or for what is no number."""
        points = np.asarray(points_mm, dtype=np.float64)
        if points.ndim < 2 or points.shape[-1] != 3:
            raise ValueError(f"points_mm: expected (..., N, 3) coordinates, got {points.shape}")
        *shape, count, _ = points.shape
        if count < least:
            raise UlnaInputError(
                f"{what}: {count} point{'s' * (count != 1)}; expected {least} at the least. Take more."
            )
        if not np.isfinite(points).all():
            raise UlnaInputError(f"{what}: a coordinate is not a finite number; expected mm. Correct the points.")
        sets = points.reshape(-1, count, 3)
        mean_mm = sets.mean(axis=1)
        at = sets - mean_mm[:, None]
        size_mm = np.sqrt((at**2).sum(axis=(1, 2)) / count)
        size_mm = np.where(size_mm > 0.0, size_mm, 1.0)
        return cls(at / size_mm[:, None, None], mean_mm, size_mm, tuple(shape), what)

    @property
    def count(self) -> int:
        """Points of each set."""
        return int(self.at.shape[1])

    def axes(self) -> tuple[F64, F64]:
        """(T, 3) extents and (T, 3, 3) principal directions as rows, the widest first."""
        # what the QR leaves is 3 × 3: no large matrix U of the singular value decomposition
        r = np.linalg.qr(self.at, mode="r") if self.count > 3 else self.at
        _, extents, directions = np.linalg.svd(r, full_matrices=True)
        found = np.zeros((len(self.at), 3))
        found[:, : extents.shape[1]] = extents
        return found, directions

    def need(self, dimensions: int, word: str, advice: str) -> tuple[F64, F64]:
        """`axes`. Raises UlnaInputError where the points of a set span fewer dimensions than needed."""
        extents, directions = self.axes()
        floor = FLAT * np.maximum(1.0, np.abs(self.mean_mm).max(axis=1) / self.size_mm / 1e3)
        flat = extents[:, dimensions - 1] <= floor * np.sqrt(self.count)
        if flat.any():
            k = int(np.argmax(flat))
            spread = self.size_mm[k] * extents[k] / np.sqrt(self.count)
            raise UlnaInputError(
                f"{self.what}: {self.in_set(k)}the {self.count} points are {word}: rms extents {spread[0]:.3g}, "
                f"{spread[1]:.3g} and {spread[2]:.3g} mm. {advice}"
            )
        return extents, directions

    def in_set(self, k: int) -> str:
        """`set 3 of 10000: ` where there are several."""
        return f"set {k + 1} of {len(self.at)}: " if len(self.at) > 1 else ""

    def vectors(self, values: F64) -> F64:
        """(T, 3) back to (..., 3)."""
        return values.reshape(*self.shape, 3)

    def numbers(self, values: F64) -> F64:
        """(T,) back to (...,)."""
        return values.reshape(self.shape)

    def one_each(self, values: ArrayLike) -> F64:
        """A number, or (..., N), as (T, N)."""
        count = (*self.shape, self.count)
        return np.broadcast_to(np.asarray(values, dtype=np.float64), count).reshape(len(self.at), self.count)

    def each(self, values: F64) -> F64:
        """(T, N) back to (..., N)."""
        return values.reshape(*self.shape, self.count)


class Fitted:
    """A surface or curve that was fitted to one set of points, or to many: the leading axes are those of the points."""

    residuals_mm: F64
    """(..., N) how far each point is off."""

    @property
    def form_mm(self) -> F64:
        """(...,) largest minus smallest residual: flatness, roundness, sphericity or cylindricity about what was
        fitted."""
        return np.asarray(self.residuals_mm.max(axis=-1) - self.residuals_mm.min(axis=-1))
