"""A lean Levenberg–Marquardt on folded normal equations, for peers that bring derivatives but no such solver.

It gives them their best case: no (N, 25) Jacobian is stored; an iteration costs one evaluation and one 25 × 25 solve.
"""

from collections.abc import Callable

import numpy as np

from benchmarks.lengths import F64, FREE

#: (27,) parameters → JᵀJ (25, 25), Jᵀr (25,), rᵀr
Folded = Callable[[F64], tuple[F64, F64, float]]


def minimise(folded: Folded, start: F64, step_tolerance: float = 1e-12, max_iterations: int = 100) -> F64:
    """Start parameters → parameters where no step helps any more. Damping follows each column's size (Marquardt)."""
    x = start.copy()
    gram, gradient, cost = folded(x)
    damping = 1e-3
    for _ in range(max_iterations):
        scale = np.sqrt(np.diag(gram))
        scaled = gram / np.outer(scale, scale)
        step = np.linalg.solve(scaled + damping * np.eye(len(scale)), -gradient / scale) / scale
        trial = x.copy()
        trial[FREE] += step
        trial_gram, trial_gradient, trial_cost = folded(trial)
        if trial_cost < cost:
            x, gram, gradient, cost = trial, trial_gram, trial_gradient, trial_cost
            damping = max(damping * 0.1, 1e-12)
        else:
            damping *= 10.0
        if np.linalg.norm(step * scale) <= step_tolerance * np.linalg.norm(x[FREE] * scale) or damping > 1e12:
            break
    return x
