"""Searches without derivatives, for those who want to compare or do not trust a gradient.

Both look for the least sum of squares in a box around the arm file's numbers, by values of the core's cost alone
(placements put where they fit best, every reading weighing alike), with SciPy's own implementations: generalized
simulated annealing (Tsallis and Stariolo 1996) without its local search, and differential evolution (Storn and Price
1997). What they find is finished by Levenberg–Marquardt; what the readings do not determine stays as the arm file has
it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need
from ulna.study.assembly import Assembled
from ulna.study.data import FitOptions
from ulna.study.study import Study

#: members of a population for each parameter, at the least
MEMBERS = 4
#: a population that spreads over no more than this part of its mean cost has found its place
SPREAD = 1e-6


@dataclass(frozen=True)
class Searched:
    """Where such a search ended."""

    parameters: F64
    """All of the problem's, those searched changed."""
    cost: float
    """mm² where no noise is stated."""
    evaluations: int


class _Counted:
    """The cost at many sets of parameters, counted against the budget."""

    def __init__(self, assembled: Assembled, hold: NDArray[np.bool_], budget: int, stage: str, progress: Any) -> None:
        self._assembled, self._hold, self._budget = assembled, hold, budget
        self._stage, self._progress = stage, progress
        self.evaluations = 0

    def __call__(self, x: F64) -> Any:
        """(k,) → a number; (k, S) → (S,)."""
        import ulna._core as _core

        sets = np.ascontiguousarray(np.atleast_2d(x.T))
        costs = _core.costs(self._assembled.problem, self._hold, sets)
        self.evaluations += len(sets)
        if self._progress is not None:
            self._progress(self._stage, min(self.evaluations, self._budget), self._budget)
        return costs if x.ndim == 2 else float(costs[0])


def search_box(study: Study, assembled: Assembled, progress: Progress | None = None) -> Searched:
    """The best point of the box that the budget allows. Reproducible by `study.fit.seed`. Raises UlnaInputError."""
    start = assembled.problem.parameters
    hold = assembled.hold | ~_of_geometry(assembled.names)
    if hold.all():
        raise UlnaInputError(
            f"{study.label}: key 'fit.method': '{study.fit.method}' searches the geometry, but 'fit.free' and "
            "'fit.hold' hold all of it; expected something to search. Free some, or use method \"lm\"."
        )
    need(f"{study.label}: key 'fit.method': '{study.fit.method}'", "scipy")
    free = np.flatnonzero(~hold)
    half = np.array([_half_width(assembled.names[k], assembled.units[k], study.fit) for k in free])
    bounds = np.stack([start[free] - half, start[free] + half], axis=1)
    counted = _Counted(assembled, hold, study.fit.budget, study.fit.method, progress)
    search = _annealing if study.fit.method == "annealing" else _evolution
    best, cost = search(counted, bounds, start[free], study.fit)
    found = start.copy()
    found[free] = best
    return Searched(found, cost, counted.evaluations)


def _of_geometry(names: list[str]) -> NDArray[np.bool_]:
    tails = ("theta0", "alpha", "a", "d", "beta")
    joints = [name.startswith("joint.") and name.rsplit(".", 1)[1] in tails for name in names]
    return np.array([joint or name.startswith("probe.") for joint, name in zip(joints, names, strict=True)])


def _half_width(name: str, unit: str, options: FitOptions) -> float:
    if unit == "mm":
        return options.box_length_mm
    if name.endswith("theta0"):
        return math.pi if options.start == "search" else options.box_offset_rad
    return options.box_angle_rad


def _annealing(cost: Callable[[F64], Any], bounds: F64, start: F64, options: FitOptions) -> tuple[F64, float]:
    from scipy.optimize import dual_annealing

    found = dual_annealing(
        cost,
        bounds,
        maxiter=options.budget,  # the budget of evaluations ends it first
        maxfun=options.budget,
        rng=np.random.default_rng(options.seed),
        no_local_search=True,
        x0=start,
    )
    return found.x, float(found.fun)


def _evolution(cost: Callable[[F64], Any], bounds: F64, start: F64, options: FitOptions) -> tuple[F64, float]:
    from scipy.optimize import differential_evolution

    members = 2 ** math.ceil(math.log2(max(MEMBERS * len(bounds), 8)))  # as a Sobol sequence wants them
    found = differential_evolution(
        cost,
        bounds,
        strategy="currenttobest1bin",
        maxiter=max(options.budget // members - 1, 1),
        popsize=MEMBERS,
        tol=SPREAD,
        mutation=(0.4, 0.9),
        recombination=0.9,
        rng=np.random.default_rng(options.seed),
        init="sobol",
        polish=False,
        updating="deferred",
        vectorized=True,
        x0=start,
    )
    return found.x, float(found.fun)
