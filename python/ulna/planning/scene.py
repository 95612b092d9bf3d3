"""What a set of measurements is chosen and judged with: rows in coordinates, information at hand, tests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, I64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.planning.information import Coordinates
from ulna.planning.spec import PlanSpec
from ulna.planning.targets import Tests

RANDOM = 20
"""Random sets that a figure of random choice is the mean of."""
SAMPLED = 1000
"""Candidates whose predictions stand for all of them in the criterion G."""

_CORE = {"D": "volume", "A": "mean", "E": "widest", "G": "worst"} | {
    "length": "mean",
    "length-worst": "worst",
    "point": "mean",
}


@dataclass(frozen=True)
class Figures:
    """What is expected of a set of measurements, from the noise alone."""

    measurements: int
    criterion: float
    """Its value: of D the mean log10 standard deviation in coordinates where the candidates' is zero; else a standard
    deviation (mm of lengths and points; of A, E and G in units of the noise)."""
    u_length_mm: float
    """Root mean square over the test lengths of what the arm contributes to their standard uncertainty."""
    u_length_worst_mm: float
    u_point_mm: float
    """The same of points, of all three coordinates, after the best rigid motion."""


@dataclass(frozen=True)
class Scene:
    """What every choice is made and judged with."""

    spec: PlanSpec
    rows: F64
    """(N, k, r) of the candidates, in coordinates."""
    coordinates: Coordinates
    fixed: F64
    """(r, r) information at hand."""
    tests: Tests

    def directions(self, rng: np.random.Generator) -> F64 | None:
        """Rows of the criterion."""
        kind = self.spec.criterion
        if kind in ("A", "E"):
            return self.coordinates.to_scaled
        if kind == "G":
            flat = self.rows.reshape(-1, self.rows.shape[2])
            return flat[rng.choice(len(flat), min(SAMPLED, len(flat)), replace=False)]
        if kind.startswith("length"):
            return self.tests.length_rows
        return self.tests.point_rows if kind == "point" else None

    def choose(self, count: int, directions: F64 | None, progress: Progress | None = None) -> I64:
        """Numbers of the candidates that make the criterion small. Raises UlnaInputError for too few."""
        import ulna._core as _core

        spec = self.spec
        try:
            chosen, _, _ = _core.choose(
                self.rows, count, _CORE[spec.criterion], directions, self.fixed, spec.seed, progress
            )
        except _core.UlnaError as error:
            raise UlnaInputError(f"{spec.label}: {error}") from None
        return np.array(chosen, dtype=np.int64)

    def covariance(self, which: I64) -> F64 | None:
        """(r, r) of a set; None where it does not determine every direction."""
        rows = self.rows[which].reshape(-1, self.rows.shape[2])
        values, vectors = np.linalg.eigh(self.fixed + rows.T @ rows)
        if values[0] <= 1e-9 * values[-1]:
            return None
        c: F64 = (vectors / values) @ vectors.T
        return c

    def figures(self, which: I64, directions: F64 | None) -> Figures | None:
        """What is expected of a set; None where it does not determine every direction."""
        c = self.covariance(which)
        if c is None:
            return None
        length = _variances(self.tests.length_rows, c)
        if directions is None:
            value = float(np.linalg.slogdet(c)[1] / (2.0 * np.log(10.0) * len(c)))
        elif self.spec.criterion == "E":
            value = float(np.sqrt(np.linalg.eigvalsh(directions @ c @ directions.T)[-1]))
        else:
            variances = _variances(directions, c) * (3.0 if self.spec.criterion == "point" else 1.0)
            value = float(np.sqrt(variances.max() if _CORE[self.spec.criterion] == "worst" else variances.mean()))
        return Figures(
            measurements=len(which),
            criterion=value,
            u_length_mm=float(np.sqrt(length.mean())),
            u_length_worst_mm=float(np.sqrt(length.max())),
            u_point_mm=float(np.sqrt(3.0 * np.vdot(c, self.tests.point_square))),
        )

    def random(self, count: int, directions: F64 | None, rng: np.random.Generator) -> Figures | None:
        """The mean over random sets (root of the mean variance)."""
        if count > len(self.rows):
            return None
        sets = (rng.choice(len(self.rows), count, replace=False) for _ in range(RANDOM))
        found = [figures for figures in (self.figures(which, directions) for which in sets) if figures is not None]
        if len(found) < RANDOM:
            return None

        def rms(name: str) -> float:
            values = np.array([getattr(figures, name) for figures in found])
            return float(values.mean() if name == "criterion" else np.sqrt((values**2).mean()))

        names = ("criterion", "u_length_mm", "u_length_worst_mm", "u_point_mm")
        return Figures(count, **{name: rms(name) for name in names})


def _variances(rows: F64, c: F64) -> F64:
    variances: F64 = np.einsum("ij,ij->i", rows @ c, rows)
    return variances
