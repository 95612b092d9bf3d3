"""What the readings say of every parameter that any model has, where a fit of the geometry alone ended.

What an arm does beyond its geometry is small, so that models differ by one step of Gauss and Newton from there: a
system of linear equations for each, of sums over the rows of each group, in place of a fit. Errors of readings left out
are then computed with the arm itself, nothing linear in them.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
from scipy.linalg import cho_factor, cho_solve

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.effects.effects import extra_of
from ulna.calibration.choosing.groups import Groups
from ulna.calibration.choosing.models import HARMONICS, asking
from ulna.calibration.running import run_assembled
from ulna.ground.arrays import F64, I64, Bool
from ulna.study.assembly import Assembled, assemble
from ulna.study.parameters import priors

DRAWN = {
    "joint.*.theta0": ("rad", 1.0),
    "joint.*.alpha": ("rad", 1.0),
    "joint.*.beta": ("rad", 1.0),
    "joint.*.a": ("mm", 1.0),
    "joint.*.d": ("mm", 1.0),
    "probe.*": ("mm", 5.0),
}
"""Geometry that is known from a drawing before any reading: its unit, and how many times less well than anything is
known (somebody mounted a probe). Without that, blocks and geometry imitate each other."""
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
    arm: Arm
    grams: list[F64]
    """(p + 1, p + 1) of each group, residuals last."""
    total: F64
    """Of all groups together."""
    equations: list[int]
    before: Before
    drawn_u: dict[str, float]
    """Pattern of `DRAWN` → standard deviation of what the drawing says."""
    variance: float
    """Of a row where the geometry alone is fitted."""

    def which(self, blocks: Sequence[str], order: int) -> I64:
        """Indices (k,) of a model's parameters: geometry, its blocks, its harmonics."""
        kept = [
            extra == "" or extra in blocks or (extra == HARMONICS and k <= order)
            for extra, k in zip(self.extra, self.order.tolist(), strict=True)
        ]
        return np.flatnonzero(kept)

    def without(self, group: int | None) -> tuple[F64, int]:
        """Sums and number of rows of all groups but one."""
        if group is None:
            return self.total, sum(self.equations)
        return self.total - self.grams[group], sum(self.equations) - self.equations[group]

    def solved(self, which: I64, u: F64, variance: float, gram: F64) -> F64:
        """(k,) how far a model's parameters are from `at`; u (k,) beforehand, variance of a row."""
        weight = penalty(u, self.scale[which], variance)
        system = gram[np.ix_(which, which)] + np.diag(weight + RIDGE)
        known = gram[which, -1] + weight * self.scale[which] * self.before.off[which]
        step: F64 = -cho_solve(cho_factor(system, lower=True), known) / self.scale[which]
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


def rows_of(groups: Groups, blocks: Sequence[str], orders: Sequence[int]) -> Rows:
    """Of all models with these blocks and orders. Raises UlnaInputError."""
    study = asking(groups.study, [HARMONICS, *blocks] if orders else list(blocks), orders or [1])
    assembled = assemble(study)
    block_of = [extra_of(name) or "" for name in assembled.names]
    geometry = assembled.hold | np.array([extra != "" for extra in block_of])
    fitted = run_assembled(study, _held(assembled, geometry))
    rows, residuals, standing = _core.rows_of_fit(assembled.problem, assembled.hold, fitted)
    free = np.flatnonzero(~assembled.hold)
    names = [assembled.names[k] for k in free]
    scale = np.linalg.norm(rows, axis=0)
    scale[scale == 0.0] = 1.0
    both = np.column_stack([rows / scale, residuals])
    group = groups.standings[standing]
    of_group = [both[group == k] for k in range(groups.count)]
    start = assembled.problem.parameters
    off = fitted.parameters[free] - start[free]
    u, drawn_u = np.full(len(free), np.inf), dict[str, float]()
    for unit, known in (("rad", study.fit.known_angle_rad), ("mm", study.fit.known_length_mm)):
        for times in sorted({times for own, times in DRAWN.values() if own == unit}):
            patterns = [pattern for pattern, own in DRAWN.items() if own == (unit, times)]
            which = [any(fnmatchcase(name, pattern) for pattern in patterns) for name in names]
            u[which] = _spread(off[which], times * known)
            drawn_u |= dict.fromkeys(patterns, _spread(off[which], times * known))
    for k, (value, stated) in priors(study, assembled.names, assembled.units, start.tolist(), assembled.hold).items():
        column = int(np.searchsorted(free, k))
        u[column], off[column] = stated, fitted.parameters[k] - value
    off[~np.isfinite(u)] = 0.0
    extra = [block_of[k] for k in free]
    left = max(len(residuals) - sum(each == "" for each in extra), 1)
    grams = [each.T @ each for each in of_group]
    return Rows(
        names=names,
        extra=extra,
        order=np.array([_order(name) for name in names], dtype=np.int64),
        scale=scale,
        free=free,
        at=fitted.parameters.copy(),
        arm=assembled.arm.with_signs(fitted.arm.signs),
        grams=grams,
        total=np.sum(grams, axis=0),
        equations=[len(each) for each in of_group],
        before=Before(u, off),
        drawn_u=drawn_u,
        variance=float(residuals @ residuals) / left,
    )


def _held(assembled: Assembled, hold: Bool) -> Assembled:
    return dataclasses.replace(assembled, hold=hold)


def _spread(off: F64, known: float) -> float:
    """How far an arm is from its drawing; no nearer than arms are known from drawings."""
    return max(known, float(np.sqrt(np.mean(off**2)))) if len(off) else known


def _order(name: str) -> int:
    found = re.fullmatch(r"joint\.\d+\.[cs](\d+)", name)
    return 0 if found is None else int(found[1])
