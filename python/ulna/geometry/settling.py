"""Gauss–Newton for many small problems at once: steps by QR, halved until the sum of squares falls.

The conditions of the problems are never squared: normal equations would lose a small cap of a ball.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ulna.ground.arrays import F64, I64, Bool

ROUNDS = 200
"""Steps at the most. A good start needs 3 to 6; a flat cap with noise some tens."""
HALVINGS = 10
"""Of a step that does not lead down; smaller ones are within rounding."""
SMALL = 1e-13
"""A step this small, of unknowns of the size of one, changes nothing."""
ROUNDING = 1e-14
"""Of a sum of squares, relative: a step that raises it by no more does not lead up."""


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

    A problem has settled when its step is within rounding: small, or no longer smaller than the last one while the sum
    of squares stays, or leading down nowhere.
    """
    state = start.copy()
    cost = (surface.residuals(state, np.ones(len(state), dtype=bool)) ** 2).sum(axis=1)
    settled, lost = np.zeros(len(state), dtype=bool), ~np.isfinite(cost)
    last = np.full(len(state), np.inf)
    for _ in range(ROUNDS):
        rest = ~settled & ~lost
        if not rest.any():
            break
        try:
            step = solved(surface.jacobian(state[rest], rest), -surface.residuals(state[rest], rest))
        except np.linalg.LinAlgError:
            break  # some problem does not determine its unknowns: it never settles
        numbers = np.flatnonzero(rest)
        size = np.abs(step).max(axis=1) / np.maximum(1.0, np.abs(state[numbers]).max(axis=1))
        lost[numbers[~np.isfinite(size)]] = True
        before = cost[numbers]
        moved = _down(surface, state, cost, numbers, step, np.isfinite(size))
        stays = before - cost[numbers] <= ROUNDING * before
        settled[numbers] = np.isfinite(size) & (~moved | (size <= SMALL) | (stays & (size >= 0.5 * last[numbers])))
        last[numbers] = size
    return state, settled


def _down(surface: Surface, state: F64, cost: F64, numbers: I64, step: F64, tried: Bool) -> Bool:
    """Take the steps of the problems `numbers`, halved until they do not lead up: `state` and `cost` are changed. Which
    of them were taken."""
    waiting, taken = tried.copy(), np.zeros(len(numbers), dtype=bool)
    for halving in range(HALVINGS):
        if not waiting.any():
            break
        own = np.zeros(len(state), dtype=bool)
        own[numbers[waiting]] = True
        there = surface.moved(state[own], 0.5**halving * step[waiting])
        new = (surface.residuals(there, own) ** 2).sum(axis=1)
        good = new <= cost[own] * (1.0 + ROUNDING)
        which = np.flatnonzero(waiting)[good]
        state[numbers[which]], cost[numbers[which]] = there[good], new[good]
        taken[which], waiting[which] = True, False
    return taken
