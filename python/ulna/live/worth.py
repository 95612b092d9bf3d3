"""What lengths are worth with what is known of an arm. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64


@dataclass(frozen=True)
class Worth:
    """How sure a length would be, now."""

    u_mm: float
    """Root mean square over the test lengths of what the arm contributes to their standard uncertainty."""
    worst_mm: float
    """The largest."""
    length_mm: float
    """Of the test bars."""

    @classmethod
    def of(cls, rows: F64, covariance: F64, length_mm: float) -> Worth:
        """From how test lengths follow the parameters, (N, F), and the covariance of these."""
        each = variances(rows, covariance)
        return cls(float(np.sqrt(each.mean())), float(np.sqrt(each.max())), length_mm)


def mean_variance(tests: F64, triangle: F64) -> float:
    """Of the test lengths, from the triangle of what is known."""
    half = np.linalg.solve(triangle.T, tests.T)
    return float((half**2).sum(axis=0).mean())


def variances(rows: F64, covariance: F64) -> F64:
    variances: F64 = np.maximum(np.einsum("ij,ij->i", rows @ covariance, rows), 0.0)
    return variances
