"""What a certificate states of an arm's parameters: values, expanded uncertainties, the region that holds them all.

Evaluated in the manner of JCGM 100:2008 (GUM) and JCGM 102:2011. k is that of `ulna uncertainty`: of the normal
distribution where the study stated the noise and the residuals do not contradict it, of Student's t with the degrees of
freedom of what the residuals showed where they had a say.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ulna.arm.unknown import Unknown
from ulna.calibration.result import Result
from ulna.calibration.summary import Parameter
from ulna.ground.arrays import F64
from ulna.ground.quantiles import fisher
from ulna.uncertainties.gum import coverage_factor
from ulna.uncertainties.regions import coverage_factor_of_region

#: coverage probability of every uncertainty in a certificate
P = 0.95


@dataclass(frozen=True)
class StatedParameters:
    """The parameters of a result, sorted by what can be said of them."""

    fitted: list[Parameter]
    """Those with an uncertainty."""
    unsure: list[Parameter]
    """Fitted, but without an uncertainty."""
    held: list[Parameter]
    lost: list[Parameter]
    """Those that take part in a combination which the readings do not determine."""
    covariance: F64
    """(n, n) of `fitted`, in mm, rad, 1/K and rad/(N m)."""
    k: float
    """Coverage factor of one parameter."""
    k_region: float
    """Coverage factor of the ellipsoid of all of `fitted`; 1 where there are none."""
    p: float
    """Coverage probability of both."""
    degrees_of_freedom: float
    """Infinite where all that the uncertainties rest on was stated."""
    unknown: Unknown | None
    """Why there are none of `unsure`."""

    @property
    def expanded(self) -> list[float]:
        """U = k u of each of `fitted`, in its unit."""
        return [self.k * float(row.u) for row in self.fitted if row.u is not None]


def stated_parameters(result: Result, p: float = P) -> StatedParameters:
    """What can be stated of a result's parameters with coverage probability p."""
    fitted = [row for row in result.parameters if row.status == "fitted" and row.u is not None]
    freedom = result.noise.degrees_of_freedom
    at = [result.covariance.names.index(row.name) for row in fitted]
    return StatedParameters(
        fitted=fitted,
        unsure=[row for row in result.parameters if row.status == "fitted" and row.u is None],
        held=[row for row in result.parameters if row.status == "held"],
        lost=[row for row in result.parameters if row.status == "not-determined"],
        covariance=np.asarray(result.covariance.matrix, dtype=np.float64)[np.ix_(at, at)],
        k=coverage_factor(p, freedom) if fitted else 1.0,
        k_region=_of_region(p, len(fitted), freedom),
        p=p,
        degrees_of_freedom=freedom,
        unknown=result.covariance.why_none,
    )


def _of_region(p: float, count: int, freedom: float) -> float:
    """k_p of so many parameters: √χ²_p, or √(n F_p(n, ν)) where their covariance was scaled by an estimated variance
    (Hotelling; JCGM 102 6.5.2.4 for the normal case)."""
    if not count:
        return 1.0
    if math.isinf(freedom):
        return coverage_factor_of_region(p, count)
    return math.sqrt(count * fisher(count, freedom, p))


def last_place(expanded: float) -> int | None:
    """The power of ten of the second digit of U: U = 0.0123 → -3. None for U = 0, which rounds nothing."""
    if not expanded > 0.0:
        return None
    return int(f"{expanded:.1e}".split("e")[1]) - 1
