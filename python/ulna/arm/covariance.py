"""What a calibration says about its parameters: their covariance, and the directions that nobody determined."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.unknown import Unknown
from ulna.ground.arrays import F64
from ulna.ground.digits import uncertainty
from ulna.ground.shown import About, Shown, Table


@dataclass(frozen=True, repr=False)
class ParameterCovariance(Shown):
    """What a calibration says about its parameters."""

    names: list[str]
    """Parameters the matrix is of."""
    matrix: F64
    """(k, k), rad and mm."""
    lost: list[dict[str, Any]]
    """Directions that the data did not determine: ``{"combination": {name: weight}, "because", "remedy", …}``."""
    unknown: Unknown | None = None
    """Why the matrix is NaN, as its calibration knew."""

    @property
    def why_none(self) -> Unknown | None:
        """Why no uncertainty is known; None where they are."""
        return None if np.isfinite(self.matrix).all() else self.unknown or Unknown("freedom")

    def over(self, names: Sequence[str]) -> F64:
        """(k, k) over these names, which contain its own; zero where it knows nothing: those parameters were held."""
        whole = np.zeros((len(names), len(names)))
        columns = [list(names).index(name) for name in self.names]
        whole[np.ix_(columns, columns)] = self.matrix
        return whole

    def of(self, names: Sequence[str]) -> ParameterCovariance:
        """That of some of the parameters alone."""
        kept = [k for k, name in enumerate(self.names) if name in names]
        lost = []
        for direction in self.lost:
            combination = {name: weight for name, weight in direction["combination"].items() if name in names}
            if combination:
                lost.append(direction | {"combination": combination})
        names_kept = [self.names[k] for k in kept]
        return ParameterCovariance(names_kept, self.matrix[np.ix_(kept, kept)], lost, self.unknown)

    def about(self) -> About:
        """Standard uncertainties; correlations are in the matrix."""
        u = np.sqrt(np.maximum(np.diag(self.matrix), 0.0)) if self.names else np.zeros(0)
        known = [float(value) if np.isfinite(value) else None for value in u]
        rows = [[name, uncertainty(value)] for name, value in zip(self.names, known, strict=True)]
        lost = f", {len(self.lost)} directions not determined" if self.lost else ""
        return About(
            f"Covariance of {len(self.names)} parameters, mm and rad{lost}", {}, [Table(["parameter", "u"], rows)]
        )


def root_of(covariance: F64) -> F64:
    """(k, k) → (k, k) a matrix whose product with its transpose it is.

    A covariance is singular along what is held or open: by eigenvectors, of what is scaled alike.
    """
    scale = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    scale[scale == 0.0] = 1.0
    sizes, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    root: F64 = scale[:, None] * vectors * np.sqrt(np.maximum(sizes, 0.0))
    return root
