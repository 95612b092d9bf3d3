"""The law of propagation of uncertainty and what belongs to it: JCGM 100:2008 (GUM), JCGM 102:2011 6.2.

Units are the caller's: of each x, of each y, and of a Jacobian y per x.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.quantiles import normal, student

STEP = 1e-3
"""Step of `numerical_jacobian` as a fraction of u. The error of central differences falls with its square: where y
curves so strongly that u counts as large, a step of 0.001 u still sees a straight line to about 1e-6 of the slope's
change. Rounding costs about 1e-16 |y| / (0.001 u), which stays below 1e-6 of the slope for u above 1e-7 of x."""


def propagate(jacobian: F64, covariance: F64) -> F64:
    """(m, n), (n, n) → (m, m), symmetric to the last bit: U_y = J U_x Jᵀ (GUM 5.2.2, JCGM 102 6.2)."""
    found = jacobian @ covariance @ jacobian.T
    symmetric: F64 = 0.5 * (found + found.T)
    return symmetric


def numerical_jacobian(function: Callable[[F64], F64], x: F64, u: F64) -> F64:
    """(m, n): ∂function_i/∂x_j at x (n,), by central differences with steps of `STEP` u_j.

    u (n,): standard uncertainties of x, at least 0. The column of an x with u = 0 is zero: that x is taken as known,
    and the column would be multiplied by nothing.
    """
    x = np.asarray(x, dtype=np.float64)
    jacobian = np.zeros((len(np.atleast_1d(function(x))), len(x)))
    for column in np.flatnonzero(u):
        above, below = x.copy(), x.copy()
        above[column] += STEP * u[column]
        below[column] -= STEP * u[column]
        # divided by the step as it was rounded on being added, not as it was meant
        apart = above[column] - below[column]
        jacobian[:, column] = (np.atleast_1d(function(above)) - np.atleast_1d(function(below))) / apart
    return jacobian


def effective_degrees_of_freedom(contributions: F64, degrees_of_freedom: F64) -> float:
    """Welch–Satterthwaite, GUM G.4.1: ν_eff = u_c⁴ / Σ u_i⁴/ν_i of independent contributions.

    contributions (n,): u_i = |c_i| u(x_i), in units of y; degrees_of_freedom (n,): ν_i, above 0, infinite where u_i
    is exactly known. Infinite where nothing of finite ν_i contributes.
    """
    largest = float(np.max(np.abs(contributions), initial=0.0))
    if largest == 0.0:
        return math.inf
    # relative to the largest, so that fourth powers of small numbers do not vanish
    shares = (np.asarray(contributions, dtype=np.float64) / largest) ** 2
    below = float((shares**2 / np.asarray(degrees_of_freedom, dtype=np.float64)).sum())
    return math.inf if below == 0.0 else float(shares.sum() ** 2 / below)


def coverage_factor(p: float, degrees_of_freedom: float = math.inf) -> float:
    """k of a two-sided interval y ± k u that covers with probability p (GUM G.3.2): normal, or Student's t.

    ν that are no whole number are taken as they are where the GUM (G.4.1) truncates or interpolates.
    """
    upper = 0.5 * (1.0 + p)
    return normal(upper) if math.isinf(degrees_of_freedom) else float(student(degrees_of_freedom, upper))
