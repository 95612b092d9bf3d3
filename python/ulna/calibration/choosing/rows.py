"""What the readings say of every parameter that any model has, where a fit of the geometry ended.

What an arm does beyond its geometry is small, so that models differ by one step of Gauss and Newton from there: a
system of linear equations for each, of sums over the rows of each group, in place of a fit. Errors of readings left out
are then computed with the arm itself, nothing linear in them.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.effects.effects import extra_of
from ulna.calibration.choosing.drawing import LENGTHS, geometry_of
from ulna.calibration.choosing.groups import Groups
from ulna.calibration.choosing.models import HARMONICS, asking
from ulna.calibration.running import run_assembled
from ulna.ground.arrays import F64, I64
from ulna.study.assembly import assemble
from ulna.study.parameters import names_like
from ulna.study.study import Study

RIDGE = 1e-10
"""Of columns of unit norm: what no reading shows stays where it is."""


@dataclass(frozen=True)
class Before:
    """What is known of parameters before any reading."""

    u: F64
    """(p,) infinite where nothing is."""
    off: F64
    """(p,) the fit of the geometry less the value that is known."""


@dataclass(frozen=True)
class Rows:
    """Sums over the rows of all models together: p parameters, in units in which each column has norm one."""

    names: list[str]
    extra: list[str]
    """(p,) to which block a parameter belongs; "" of geometry."""
    order: I64
    """(p,) of an amplitude of harmonics, else 0."""
    scale: F64
    """(p,) a parameter times its scale is in those units."""
    free: I64
    """(p,) index in all parameters of the problem."""
    at: F64
    """All parameters where the fit of the geometry ended."""
    alone: F64
    """The same of geometry alone, without the drawing."""
    arm: Arm
    grams: list[F64]
    """(p + 1, p + 1) of each group, residuals last."""
    equations: list[int]
    """Of each group."""
    before: Before
    drawn_u: dict[str, float]
    """Pattern → standard deviation of what the drawing says."""
    variance: float
    """Of a row where the geometry is fitted."""
    lengths: I64
    """Indices of links' lengths, where the study itself states nothing of them."""

    @cached_property
    def total(self) -> F64:
        """Of all groups together."""
        found: F64 = np.sum(self.grams, axis=0)
        return found

    def which(self, blocks: Sequence[str], order: int) -> I64:
        """Indices (k,) of a model's parameters: geometry, its blocks, its harmonics."""
        kept = [
            extra == "" or extra in blocks or (extra == HARMONICS and k <= order)
            for extra, k in zip(self.extra, self.order.tolist(), strict=True)
        ]
        return np.flatnonzero(kept)

    def solved(self, which: I64, u: F64, variance: float, gram: F64) -> F64:
        """(k,) how far a model's parameters are from `at`; u (k,) beforehand, variance of a row."""
        weight = penalty(u, self.scale[which], variance)
        system = gram[np.ix_(which, which)] + np.diag(weight + RIDGE)
        known = gram[which, -1] + weight * self.scale[which] * self.before.off[which]
        step: F64 = -np.linalg.solve(system, known) / self.scale[which]
        return step

    def parameters(self, which: I64, step: F64) -> F64:
        """All parameters of the problem with that step."""
        found = self.at.copy()
        found[self.free[which]] += step
        return found

    def arm_of(self, parameters: F64) -> Arm:
        """The arm with them."""
        return self.arm.with_parameters(parameters[: len(self.arm.parameter_names)])


def penalty(u: F64, scale: F64, variance: float) -> F64:
    """(k,) what is known beforehand, as so many rows of unit norm; 0 where nothing is."""
    found: F64 = np.zeros(len(u))
    known = np.isfinite(u)
    found[known] = variance / (u[known] * scale[known]) ** 2
    return found


def rows_of(groups: Groups, blocks: Sequence[str], orders: Sequence[int], near: Mapping[str, float]) -> Rows:
    """Of all models with these blocks and orders; near: where the plain fit ends. Raises UlnaInputError."""
    geometry = geometry_of(asking(groups.study, [HARMONICS, *blocks], orders), near)
    assembled, fitted = geometry.assembled, geometry.fitted
    rows, residuals, standing = _core.rows_of_fit(assembled.problem, assembled.hold, fitted)
    free = np.flatnonzero(~assembled.hold)
    names = [assembled.names[k] for k in free]
    scale = np.linalg.norm(rows, axis=0)
    scale[scale == 0.0] = 1.0
    group = groups.standings[standing]
    u, off = np.full(len(free), np.inf), np.zeros(len(free))
    for k, (value, stated) in geometry.known.items():
        column = int(np.searchsorted(free, k))
        u[column], off[column] = stated, fitted.parameters[k] - value
    extra = [extra_of(name) or "" for name in names]
    both = np.column_stack([rows / scale, residuals])
    of_group = [both[group == k] for k in range(groups.count)]
    left = max(len(residuals) - sum(each == "" for each in extra), 1)
    return Rows(
        names=names,
        extra=extra,
        order=np.array([_order(name) for name in names], dtype=np.int64),
        scale=scale,
        free=free,
        at=fitted.parameters.copy(),
        alone=geometry.alone.parameters.copy(),
        arm=assembled.arm.with_signs(fitted.arm.signs),
        grams=[each.T @ each for each in of_group],
        equations=[len(each) for each in of_group],
        before=Before(u, off),
        drawn_u=geometry.drawn_u,
        variance=float(residuals @ residuals) / left,
        lengths=_lengths(groups.study, names),
    )


def alone_without(rows: Rows, training: Study) -> Arm:
    """The arm of a plain fit of the geometry to some of the readings, from where that to all of them ended. Raises
    UlnaInputError."""
    given = training.with_arm(training.arm.with_signs(rows.arm.signs))
    asked = asking(dataclasses.replace(given, fit=dataclasses.replace(given.fit, start="given")), [], [1])
    assembled = assemble(asked)
    of_all = dict(zip(rows.arm.parameter_names, rows.alone.tolist(), strict=False))
    start = assembled.problem.parameters.copy()
    for k, name in enumerate(assembled.arm.parameter_names):
        start[k] = of_all[name]
    fitted = run_assembled(asked, assembled, None, start, search=False)
    return assembled.arm.with_parameters(fitted.parameters[: len(assembled.arm.parameter_names)])


def _lengths(study: Study, names: list[str]) -> I64:
    stated = {name for pattern in study.fit.prior for name in names_like(pattern, names)}
    own = {name for pattern in LENGTHS for name in names_like(pattern, names)} - stated
    return np.flatnonzero([name in own for name in names])


def _order(name: str) -> int:
    found = re.fullmatch(r"joint\.\d+\.[cs](\d+)", name)
    return 0 if found is None else int(found[1])
