"""SciPy's least_squares (MINPACK's Levenberg–Marquardt) with an analytic Jacobian in NumPy."""

import numpy as np
import scipy
from scipy.optimize import least_squares

from benchmarks.lengths import F64, FREE, Lengths
from benchmarks.peers import Contender
from benchmarks.peers.numpy_map import residuals, residuals_and_jacobian, tips
from benchmarks.tasks import measure_functions


def fit(start: F64, data: Lengths) -> F64:
    """Start parameters and lengths → fitted parameters, the held ones unchanged."""

    def full(free: F64) -> F64:
        x = start.copy()
        x[FREE] = free
        return x

    found = least_squares(
        lambda free: residuals(full(free), data),
        start[FREE],
        jac=lambda free: residuals_and_jacobian(full(free), data)[1],
        method="lm",
        x_scale="jac",
        xtol=1e-12,
        ftol=1e-12,
        gtol=1e-12,
    )
    return full(np.asarray(found.x, np.float64))


def contender() -> Contender:
    return Contender(
        "SciPy, NumPy Jacobian",
        f"SciPy {scipy.__version__}, NumPy {np.__version__}",
        "least_squares(method='lm', x_scale='jac'), an analytic Jacobian in vectorised NumPy, (N, 25) stored",
        lambda quick: measure_functions(tips, residuals_and_jacobian, fit, quick),
    )
