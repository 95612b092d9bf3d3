"""Points in memory with all that is known of how they err together, and lengths between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import ArrayLike

from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.arrays import F64, I64
from ulna.ground.digits import decimals, fixed
from ulna.ground.shown import About, Shown, Table
from ulna.measuring.tip_uncertainty import COVARIANCE
from ulna.measuring.together import Together


@dataclass(frozen=True)
class Length:
    """The distance between two measured points."""

    value_mm: float
    u_mm: float | None
    """Standard uncertainty, with what the two points have in common; None where it is not known, or not determined."""


@dataclass(frozen=True, repr=False)
class Measured(Shown):
    """N points, mm, in the arm's base frame."""

    arm: Arm
    q_rad: F64
    """(N, n) what the encoders read."""
    probes: list[str]
    """(N,) which was on."""
    points_mm: F64
    """(N, 3)"""
    covariance_mm2: F64 | None
    """(N, 3, 3) of each point; NaN where it depends on what the calibration did not determine; None of an arm of which
    no uncertainty is known."""
    noise: ReadingNoise
    """That went into it."""
    notes: list[str]
    """Why uncertainties were left empty, and what to do about it."""
    ids: list[str] | None = None
    """(N,) where the readings have them."""
    conditions: Conditions | None = None
    """Of the poses, as the core takes them."""

    def __len__(self) -> int:
        return len(self.points_mm)

    @property
    def u_mm(self) -> F64 | None:
        """(N, 3) standard uncertainties of the coordinates."""
        if self.covariance_mm2 is None:
            return None
        u_mm: F64 = np.sqrt(np.maximum(np.diagonal(self.covariance_mm2, axis1=1, axis2=2), 0.0))
        return u_mm

    def joint_covariance_mm2(self, points: Sequence[int] | I64 | None = None) -> F64:
        """(3k, 3k) of k points together (None: of all), x, y, z of one after the other.

        Points of one arm err together, for its parameters are the same for all; the noise of its reading is each
        point's own. NaN as in `covariance_mm2`. Raises ValueError of an arm of which no uncertainty is known,
        IndexError for a point that there is not.
        """
        rows = np.arange(len(self)) if points is None else self._rows(points)
        together = self._together(rows)
        assert self.covariance_mm2 is not None
        return together.covariance_mm2(np.asarray(np.isnan(self.covariance_mm2[rows]).any(axis=(1, 2))))

    def length(self, first: int, second: int) -> Length:
        """Between two points, by their numbers from 0. Raises IndexError; ValueError where they are one place."""
        value, u = self.lengths([first], [second])
        known = u is not None and np.isfinite(u[0])
        return Length(float(value[0]), float(u[0]) if known and u is not None else None)

    def lengths(self, first: ArrayLike, second: ArrayLike) -> tuple[F64, F64 | None]:
        """(K,) distances, mm, between points by their numbers, and their standard uncertainties (K,) mm.

        GUM's law with what the points have in common: u² = g (J_b - J_a) C (J_b - J_a)ᵀ gᵀ and the readings' noise at
        both, g the direction from a to b. So what moves both ends alike, as the base frame does, counts for nothing.
        NaN where a length depends on what was not determined; None of an arm of which no uncertainty is known. Raises
        IndexError; ValueError where two points are one place.
        """
        a, b = self._rows(first), self._rows(second)
        apart_mm = self.points_mm[b] - self.points_mm[a]
        value_mm = np.linalg.norm(apart_mm, axis=1)
        if not (value_mm > 0.0).all():
            raise ValueError("lengths: two points are in the same place; a length of nothing has no direction")
        if self.covariance_mm2 is None:
            return value_mm, None
        return value_mm, self._together(np.concatenate([a, b])).lengths_u_mm(apart_mm / value_mm[:, None])

    def to_polars(self) -> pl.DataFrame:
        """A row for each point: id, probe, x_mm, y_mm, z_mm; where uncertainties are known u_x_mm, … and c_xx_mm2, …"""
        columns: dict[str, Any] = {} if self.ids is None else {"id": self.ids}
        columns["probe"] = self.probes
        columns |= {f"{axis}_mm": self.points_mm[:, k] for k, axis in enumerate("xyz")}
        if self.covariance_mm2 is not None and self.u_mm is not None:
            columns |= {f"u_{axis}_mm": self.u_mm[:, k] for k, axis in enumerate("xyz")}
            i, j = np.triu_indices(3)
            columns |= {f"{name}_mm2": self.covariance_mm2[:, i[k], j[k]] for k, name in enumerate(COVARIANCE)}
        return pl.DataFrame(columns, nan_to_null=True)

    def to_pandas(self) -> Any:
        """The same as a DataFrame of pandas. Errors: ModuleNotFoundError where pandas is not installed."""
        import pandas as pd

        return pd.DataFrame({series.name: series.to_numpy() for series in self.to_polars()})

    def about(self) -> About:
        """The points."""
        u_mm = self.u_mm
        heads = ["point", "x / mm", "y / mm", "z / mm"]
        heads += [] if u_mm is None else ["u(x) / mm", "u(y) / mm", "u(z) / mm"]
        names = self.ids or [str(k) for k in range(len(self))]
        rows = []
        for k, point in enumerate(self.points_mm.tolist()):
            own = [math.nan] * 3 if u_mm is None else u_mm[k].tolist()
            shown = [fixed(value, decimals(u, "mm")) for value, u in zip(point, own, strict=True)]
            if u_mm is not None:
                shown += [fixed(u, decimals(u, "mm")) if math.isfinite(u) else "–" for u in own]
            rows.append([names[k], *shown])
        known = "no uncertainty is known of this arm" if u_mm is None else "standard uncertainties u"
        title = f"{len(self)} point{'s' * (len(self) != 1)} measured with '{self.arm.name}': {known}"
        return About(title, tables=[Table(heads, rows)], notes=self.notes)

    def _rows(self, points: ArrayLike) -> I64:
        rows = np.atleast_1d(np.asarray(points))
        if rows.ndim != 1 or rows.dtype.kind not in "iu":
            raise ValueError(f"points: expected whole numbers, one after the other, got {rows.dtype} {rows.shape}")
        if len(rows) and not (rows.min() >= 0 and rows.max() < len(self)):
            raise IndexError(f"points: there are {len(self)}, numbered from 0; got {rows.min()} to {rows.max()}")
        return rows.astype(np.int64)

    def _together(self, rows: I64) -> Together:
        if self.covariance_mm2 is None:
            raise ValueError(f"no uncertainty is known of arm '{self.arm.name}': measure with a result")
        index = np.array([list(self.arm.probes).index(self.probes[row]) for row in rows.tolist()], dtype=np.int64)
        return Together(self.arm, self.q_rad[rows], index, self.noise, self.conditions or Conditions(), rows)
