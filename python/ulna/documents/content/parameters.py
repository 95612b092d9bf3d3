"""What is known of the parameters: estimates, uncertainties, correlations, and how well the readings see them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.covariance import ParameterCovariance
from ulna.arm.probes import ProbeView
from ulna.arm.unknown import Unknown
from ulna.calibration.observability import indices
from ulna.calibration.result import Result
from ulna.ground.arrays import F64
from ulna.uncertainties.gum import coverage_factor

COVERAGE = 0.95
"""Of every U of a parameter."""


@dataclass(frozen=True)
class ParameterRow:
    """One parameter."""

    name: str
    unit: str
    nominal: float
    estimate: float
    u: float | None
    """Standard uncertainty; None where held, not determined or not to be estimated."""
    expanded: float | None
    """U = k u."""
    ratio: float | None
    """(estimate - nominal) / u."""
    status: str
    """"fitted", "held" or "not-determined"."""
    cause: str | None
    """Why it is not determined, by its key: "base-frame", "probe-on-axis", …; None where it is, or nobody knows."""
    reason: str | None
    """The same in the words of the identification (English)."""


@dataclass(frozen=True)
class Parameters:
    """The parameters and what is known of them."""

    rows: list[ParameterRow]
    k: float
    """Coverage factor of every U."""
    p: float
    """Coverage probability that k stands for."""
    degrees_of_freedom: float
    """Of every u; infinite where all that it rests on was stated."""
    unknown: Unknown | None
    """Why there is no u; None where there is."""
    probes: list[ProbeView]
    correlation_names: list[str]
    correlation: F64
    """(k, k), NaN where it is not known."""


@dataclass(frozen=True)
class Observability:
    """How well the readings determine the parameters."""

    singular_values: F64
    """(k,) descending, of the Jacobian with columns of unit norm, placements eliminated."""
    determined: int
    indices: dict[str, float]
    """O1 to O5 over the determined directions, columns scaled to a root mean square of one over the equations."""
    equations: int
    """Equations less the unknowns of the placements."""


def parameters(result: Result) -> Parameters:
    """Every parameter, none left out.

    k is of Student's distribution where residuals had a say in u, with their degrees of freedom, and normal where the
    noise was stated and they do not contradict it (GUM G.3.2, G.6.4).
    """
    freedom, unknown = result.noise.degrees_of_freedom, result.covariance.why_none
    k = coverage_factor(COVERAGE, freedom) if unknown is None else math.nan
    lost: dict[str, dict[str, Any]] = {}
    for direction in result.identifiability.lost:
        for name in direction["combination"]:
            lost.setdefault(name, direction)
    rows = []
    for row in result.parameters:
        u = row.u
        why = lost.get(row.name, {}) if row.status == "not-determined" else {}
        rows.append(
            ParameterRow(
                name=row.name,
                unit=row.unit,
                nominal=row.start,
                estimate=row.value,
                u=u,
                expanded=None if u is None or math.isnan(k) else k * u,
                ratio=(row.value - row.start) / u if u else None,
                status=row.status,
                cause=why.get("cause"),
                reason=why.get("because"),
            )
        )
    known = {row.name for row in rows if row.u is not None}
    names, matrix = correlation(result.covariance.of([name for name in result.covariance.names if name in known]))
    return Parameters(rows, k, COVERAGE, freedom, unknown, result.probes, names, matrix)


def correlation(covariance: ParameterCovariance) -> tuple[list[str], F64]:
    """r_ij = C_ij / √(C_ii C_jj) (GUM 5.2.2) of the parameters whose variance is known and not zero."""
    matrix = np.asarray(covariance.matrix, dtype=np.float64)
    variance = np.diag(matrix) if matrix.size else np.zeros(0)
    kept = np.flatnonzero(np.isfinite(variance) & (variance > 0.0))
    u = np.sqrt(variance[kept])
    found = matrix[np.ix_(kept, kept)] / np.outer(u, u)
    return [covariance.names[k] for k in kept], found


def observability(result: Result) -> Observability | None:
    """From the result's singular values; None where nothing was free or determined."""
    values = np.array(result.identifiability.singular_values, dtype=np.float64)
    determined = result.identifiability.determined
    equations = result.fit.observations - result.fit.placement_unknowns
    if determined < 1 or equations < 1 or not len(values):
        return None
    # columns of unit norm over all equations: of root mean square one they are √R longer
    scaled = values[:determined] * math.sqrt(equations)
    return Observability(values, determined, indices(scaled, equations), equations)
