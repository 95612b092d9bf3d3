"""How wrong the zero offsets may start: one start, the same with what the fit does on its own, and a search."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.ground.arrays import Progress
from ulna.reproduce.cheng2011.arms import simulated
from ulna.reproduce.cheng2011.simulation import length_problem, lengths_between, random_poses

WRONG_BY_RAD = (0.1, 0.3, 1.0, 2.0, pi)
WRONG_BY_MM = 100.0
FOUND_MM = 1e-6
"""A start has found the arm when fresh lengths are right to this: the arm, or one that cannot be told from it."""


@dataclass(frozen=True)
class Convergence:
    """Of `starts` wrong starts, how many found the arm."""

    wrong_by_rad: float
    """Every zero offset is off by up to this, uniformly; every length by up to `WRONG_BY_MM`."""
    starts: int
    one_start: int
    """One run of Levenberg–Marquardt, as the paper does."""
    given: int
    """The program's default: a poor minimum is noticed and searched on from."""
    search: int
    """Searched from the beginning: nothing is assumed of the zero offsets."""


def study_convergence(seed: int, starts: int, progress: Progress | None) -> list[Convergence]:
    """For each size of error, `starts` random starts on 101 exact lengths of the arm of Table 2, r = 10 mm."""
    truth, _ = simulated(10.0)
    rng = np.random.default_rng([seed, 100])
    problem = length_problem(truth, truth, rng)
    fresh = random_poses(truth, rng, 50), random_poses(truth, rng, 50)
    expected = lengths_between(truth, *fresh)
    hold = np.zeros(len(truth.parameters), dtype=bool)

    def finds(fitted: _core.Fitted) -> bool:
        found = truth.with_parameters(fitted.parameters)
        return bool(np.abs(lengths_between(found, *fresh) - expected).max() < FOUND_MM)

    results = []
    for number, wrong_by_rad in enumerate(WRONG_BY_RAD):
        one_start = given = search = 0
        draw = np.random.default_rng([seed, 200 + number])
        for k in range(starts):
            if progress is not None:
                progress("convergence", number * starts + k, len(WRONG_BY_RAD) * starts)
            wrong = problem.with_arm(wrong_start(truth, wrong_by_rad, draw).core)
            fitted = _core.fit(wrong, hold, seed=k)
            good = finds(fitted)
            given += good
            one_start += good and not fitted.search_reason
            search += finds(_core.fit(wrong, hold, start="search", seed=k))
        results.append(Convergence(wrong_by_rad, starts, one_start, given, search))
    return results


def wrong_start(truth: Arm, wrong_by_rad: float, rng: np.random.Generator) -> Arm:
    """Zero offsets off by up to `wrong_by_rad`, lengths (probe too) by up to `WRONG_BY_MM`, twists as drawn."""
    size = [
        wrong_by_rad if name.endswith("theta0") else WRONG_BY_MM if unit == "mm" else 0.0
        for name, unit in zip(truth.parameter_names, truth.parameter_units, strict=True)
    ]
    return truth.with_parameters(truth.parameters + np.array(size) * rng.uniform(-1.0, 1.0, len(size)))
