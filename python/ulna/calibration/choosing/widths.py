"""How large parameters of blocks are before any reading: such that all readings together are likeliest.

With the geometry and other blocks taken out of the rows, a block's parameters are τ w times standard normal numbers; of
harmonics w falls with the order, else it is one. In the axes of the matrix of information the restricted likelihood
(Patterson and Thompson 1971) of τ² over the variance of a row is a sum, and its maximum is found on a grid. What
nothing shows comes out as none, so that a block that is not needed does no harm.

Of several blocks the small ones go first, harmonics last: many amplitudes imitate what few parameters explain as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.effects.effects import EFFECTS
from ulna.calibration.choosing.models import HARMONICS, Model
from ulna.calibration.choosing.rows import RIDGE, Rows, penalty
from ulna.ground.arrays import F64, I64

LEAST, MOST = 1e-6, 1.0 / 3.0
"""Of what may be of a parameter before anybody has measured: τ is sought from one part of it to the other."""
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
    learned: dict[str, float]
    """Block → τ; of harmonics that of order 1."""


@dataclass(frozen=True)
class _Part:
    """Parameters whose τ is learned."""

    name: str
    own: I64
    shape: F64
    """(k,) w."""
    least: float
    most: float


def known_of(rows: Rows, model: Model) -> Known:
    """For all readings together."""
    which = rows.which(model.blocks, model.order)
    u = np.full(len(rows.names), np.inf)
    u[which] = rows.before.u[which]
    u[rows.lengths] *= model.lengths
    parts = _parts(rows, which, model)
    for part in parts:
        u[part.own] = part.least * part.shape
    learned, variance = dict[str, float](), rows.variance
    free = sum(rows.extra[k] == "" for k in which)
    for part in (*parts, *parts[:-1]):
        rest = np.setdiff1d(which, part.own)
        weight = penalty(u[rest], rows.scale[rest], variance)
        learned[part.name], variance = _likeliest(rows, part, rest, weight, free)
        u[part.own] = learned[part.name] * part.shape
    if not parts:
        variance = _settled(rows, which, u[which])
    return Known(which, u[which], variance, learned)


def _parts(rows: Rows, which: I64, model: Model) -> list[_Part]:
    """What is learned, in that order."""
    found = []
    for name in (*model.blocks, *([HARMONICS] if model.order else [])):
        own = which[[rows.extra[k] == name for k in which]]
        if name not in model.stated and len(own):
            shape = falling(model.fall, rows.order[own]) if name == HARMONICS else np.ones(len(own))
            found.append(_Part(name, own, shape, LEAST * EFFECTS[name].drawn, MOST * EFFECTS[name].drawn))
    return found


def falling(fall: float | None, order: I64) -> F64:
    """(k,) of amplitudes of these orders, that of order 1 being about one."""
    k = order.astype(np.float64)
    found: F64 = np.ones(len(k)) if fall is None else np.sqrt(1.0 / k**2 + fall**2)
    return found


def _likeliest(rows: Rows, part: _Part, rest: I64, weight: F64, free: int) -> tuple[float, float]:
    """τ, and the variance of a row. rest: all other parameters, which weight goes with; free: how many parameters the
    readings alone determine."""
    own, shape = part.own, part.shape
    gram, equations = rows.total, sum(rows.equations)
    system = gram[np.ix_(rest, rest)] + np.diag(weight + RIDGE)
    known = gram[rest, -1] + weight * rows.scale[rest] * rows.before.off[rest]
    between = gram[np.ix_(rest, own)]
    solved = np.linalg.solve(system, np.column_stack([between, known]))
    scaled = shape * rows.scale[own]
    information = (gram[np.ix_(own, own)] - between.T @ solved[:, :-1]) * np.outer(scaled, scaled)
    sizes, axes = np.linalg.eigh(information)
    sizes = np.maximum(sizes, 0.0)
    told = (axes.T @ (scaled * (gram[own, -1] - between.T @ solved[:, -1]))) ** 2
    off = rows.before.off[rest] * rows.scale[rest]
    total = float(gram[-1, -1] + weight @ off**2 - known @ solved[:, -1])
    freedom = max(equations - free, 1)

    def left(ratio: F64) -> F64:
        """(m,) the sum of squares at these τ² over the variance."""
        found: F64 = np.maximum(total - (told * ratio[:, None] / (1.0 + ratio[:, None] * sizes)).sum(axis=1), 1e-300)
        return found

    unit = rows.variance or 1.0
    low, high = np.log(part.least**2 / unit), np.log(part.most**2 / unit)
    for _ in range(3):  # ever finer, about the largest
        tried = np.exp(np.linspace(low, high, GRID))
        cost = freedom * np.log(left(tried)) + np.log1p(tried[:, None] * sizes).sum(axis=1)
        best = int(np.argmin(cost))
        low, high = np.log(tried[max(best - 1, 0)]), np.log(tried[min(best + 1, GRID - 1)])
    variance = float(left(tried[best : best + 1])[0]) / freedom
    first = float(np.sqrt(tried[best] * variance))
    return min(max(first, part.least), part.most), variance


def _settled(rows: Rows, which: I64, u: F64) -> float:
    """The variance of a row over its degrees of freedom, what is known beforehand weighed by it."""
    variance, equations = rows.variance, sum(rows.equations)
    inner, known = rows.total[np.ix_(which, which)], rows.total[which, -1]
    for _ in range(ROUNDS):
        weight = penalty(u, rows.scale[which], variance)
        inverse = np.linalg.inv(inner + np.diag(weight + RIDGE))
        step = rows.solved(which, u, variance, rows.total) * rows.scale[which]
        squares = float(rows.total[-1, -1] + 2.0 * known @ step + step @ inner @ step)
        freedom = equations - len(which) + float(weight @ np.diag(inverse))
        found = max(squares, 0.0) / max(freedom, 1.0)
        if abs(found - variance) <= MET * variance:
            return found
        variance = found
    return variance
