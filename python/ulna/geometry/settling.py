"""Gauss–Newton for many small problems at once: steps by QR, halved until the sum of squares falls.

The conditions of the problems are never squared: normal equations would lose a small cap of a ball.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
Bool = NDArray[np.bool_]

ROUNDS = 200
"""Steps at the most. A good start needs 3 to 6; a flat cap with noise some tens."""
HALVINGS = 12
"""Of a step that does not lead down; smaller ones are within rounding."""
SMALL = 1e-14
"""A step this small, of unknowns of the size of one, changes nothing."""


class Surface(Protocol):
    """What is fitted: residuals of T problems of size one with their derivatives."""

    def residuals(self, state: F64, own: Bool) -> F64:
        """(S, m) at (S, k) states of the problems `own` (T,)."""

    def jacobian(self, state: F64, own: Bool) -> F64:
        """(S, m, steps)"""

    def moved(self, state: F64, step: F64) -> F64:
        """(S, k) states after (S, steps)."""


def solved(jacobian: F64, right: F64) -> F64:
    """(T, k) least squares of (T, N, k) rows, by QR. Where rows do not determine it: what LinAlgError or inf tells."""
    q, r = np.linalg.qr(jacobian)
    solution: F64 = np.linalg.solve(r, np.einsum("tnk,tn->tk", q, right)[..., None])[..., 0]
    return solution


def settle(surface: Surface, start: F64) -> tuple[F64, Bool]:
    """(T, k) least-squares states from (T, k) starts, and which of them (T,) settled.

    A problem has settled when its step is within rounding, or when no step leads down any more.
    """
    state = start.copy()
    rest = np.ones(len(state), dtype=bool)
    cost = (surface.residuals(state, rest) ** 2).sum(axis=1)
    for _ in range(ROUNDS):
        if not rest.any():
            break
        here = state[rest]
        try:
            step = solved(surface.jacobian(here, rest), -surface.residuals(here, rest))
        except np.linalg.LinAlgError:
            break  # some problem does not determine its unknowns: it never settles
        size = np.abs(step).max(axis=1)
        rest, state, cost = _down(surface, state, cost, rest, step, size)
    return state, ~rest


def _down(surface: Surface, state: F64, cost: F64, rest: Bool, step: F64, size: F64) -> tuple[Bool, F64, F64]:
    """One step of each of the rest, halved until it leads down. Returns who goes on, the states and costs."""
    numbers = np.flatnonzero(rest)
    go_on = np.isfinite(size)
    open_ = go_on.copy()
    share = 1.0
    state, cost, done = state.copy(), cost.copy(), np.zeros(len(numbers), dtype=bool)
    for _ in range(HALVINGS):
        own = np.zeros_like(rest)
        own[numbers[open_]] = True
        if not own.any():
            break
        tried = surface.moved(state[own], share * step[open_])
        new = (surface.residuals(tried, own) ** 2).sum(axis=1)
        better = new < cost[own]
        taken = np.flatnonzero(open_)[better]
        state[numbers[taken]], cost[numbers[taken]] = tried[better], new[better]
        open_[taken] = False
        small = open_ & (share * size <= 1e3 * SMALL * np.maximum(1.0, np.abs(state[numbers]).max(axis=1)))
        done |= small  # no way down, and the step is within rounding
        open_ &= ~small
        share *= 0.5
    scale = np.maximum(1.0, np.abs(state[numbers]).max(axis=1))
    done |= (size <= SMALL * scale) | open_  # also where halving found no way down: that is the bottom, as far as seen
    going = rest.copy()
    going[numbers] = go_on & ~done
    stuck = ~go_on
    going[numbers[stuck]] = True
    return going, state, cost
