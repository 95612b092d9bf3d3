"""How large amplitudes of harmonics are before any reading: such that all readings together are likeliest.

With the geometry and other blocks taken out of the rows, amplitudes of order k are τ w_k times standard normal numbers.
In the axes of the matrix of information the restricted likelihood (Patterson and Thompson 1971) of τ² over the variance
of a row is a sum, and its maximum is found on a grid. Amplitudes that nothing shows come out as none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ulna.calibration.choosing.models import HARMONICS, Model, Width
from ulna.calibration.choosing.rows import RIDGE, Rows, penalty
from ulna.ground.arrays import F64, I64

LEAST_RAD, MOST_RAD = 1e-8, 2e-3
"""Between which τ is sought."""
GRID = 121
ROUNDS = 20
MET = 1e-4


@dataclass(frozen=True)
class Known:
    """What is known before any reading of a model's parameters, and the variance of a row that goes with it."""

    which: I64
    """(k,) the parameters."""
    u: F64
    """(k,) infinite where nothing is known."""
    variance: float
    first_rad: float | None
    """τ: of an amplitude of order 1."""


def known_of(rows: Rows, model: Model) -> Known:
    """For all readings together."""
    which = rows.which(model.blocks, model.order)
    u = rows.before.u[which].copy()
    gram, equations = rows.without(None)
    width = model.width
    if width is not None and width.learned:
        own = np.array([rows.extra[k] == HARMONICS for k in which], dtype=bool)
        shape = falling(width, rows.order[which[own]])
        first, variance = _likeliest(rows, gram, equations, (which[~own], which[own]), shape)
        u[own] = first * shape
        return Known(which, u, variance, first)
    usual: float | None = None
    if width is not None:
        usual = float(u[[rows.extra[k] == HARMONICS and rows.order[k] == 1 for k in which]].mean())
    return Known(which, u, _settled(rows, gram, equations, which, u), usual)


def falling(width: Width, order: I64) -> F64:
    """(k,) of amplitudes of these orders, that of order 1 being about one."""
    k = order.astype(np.float64)
    found: F64 = np.ones(len(k)) if width.fall is None else np.sqrt(1.0 / k**2 + width.fall**2)
    return found


def _likeliest(rows: Rows, gram: F64, equations: int, parts: tuple[I64, I64], shape: F64) -> tuple[float, float]:
    """τ, and the variance of a row. parts: all else, amplitudes."""
    rest, own = parts
    weight = penalty(rows.before.u[rest], rows.scale[rest], rows.variance)
    system = gram[np.ix_(rest, rest)] + np.diag(weight + RIDGE)
    known = gram[rest, -1] + weight * rows.scale[rest] * rows.before.off[rest]
    between = gram[np.ix_(rest, own)]
    solved = cho_solve(cho_factor(system, lower=True), np.column_stack([between, known]))
    scaled = shape * rows.scale[own]
    information = (gram[np.ix_(own, own)] - between.T @ solved[:, :-1]) * np.outer(scaled, scaled)
    sizes, axes = np.linalg.eigh(information)
    sizes = np.maximum(sizes, 0.0)
    told = (axes.T @ (scaled * (gram[own, -1] - between.T @ solved[:, -1]))) ** 2
    off = rows.before.off[rest] * rows.scale[rest]
    total = float(gram[-1, -1] + weight @ off**2 - known @ solved[:, -1])
    freedom = max(equations - len(rest), 1)

    def left(ratio: F64) -> F64:
        """(m,) the sum of squares at these τ² over the variance."""
        found: F64 = np.maximum(total - (told * ratio[:, None] / (1.0 + ratio[:, None] * sizes)).sum(axis=1), 1e-300)
        return found

    unit = rows.variance or 1.0
    low, high = np.log(LEAST_RAD**2 / unit), np.log(MOST_RAD**2 / unit)
    for _ in range(3):  # ever finer, about the largest
        tried = np.exp(np.linspace(low, high, GRID))
        cost = freedom * np.log(left(tried)) + np.log1p(tried[:, None] * sizes).sum(axis=1)
        best = int(np.argmin(cost))
        low, high = np.log(tried[max(best - 1, 0)]), np.log(tried[min(best + 1, GRID - 1)])
    variance = float(left(tried[best : best + 1])[0]) / freedom
    first = float(np.sqrt(tried[best] * variance))
    return min(max(first, LEAST_RAD), MOST_RAD), variance


def _settled(rows: Rows, gram: F64, equations: int, which: I64, u: F64) -> float:
    """The variance of a row over its degrees of freedom, what is known beforehand weighed by it."""
    variance = rows.variance
    inner, known = gram[np.ix_(which, which)], gram[which, -1]
    for _ in range(ROUNDS):
        weight = penalty(u, rows.scale[which], variance)
        inverse = cho_solve(cho_factor(inner + np.diag(weight + RIDGE), lower=True), np.eye(len(which)))
        step = rows.solved(which, u, variance, gram) * rows.scale[which]
        squares = float(gram[-1, -1] + 2.0 * known @ step + step @ inner @ step)
        freedom = equations - len(which) + float(weight @ np.diag(inverse))
        found = max(squares, 0.0) / max(freedom, 1.0)
        if abs(found - variance) <= MET * variance:
            return found
        variance = found
    return variance
