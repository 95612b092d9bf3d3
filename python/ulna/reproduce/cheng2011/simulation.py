"""The simulation of Tables 2 and 3: what 101 exact lengths determine, with and without a bend of the probe."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.ground.arrays import F64
from ulna.reproduce.cheng2011.arms import simulated

LENGTHS = 101
FRESH = 200


@dataclass(frozen=True)
class Simulated:
    """A calibration with exact lengths."""

    r_mm: float
    """Bend of the probe."""
    converged: bool
    iterations: int
    parameters: int
    determined: int
    lost: list[dict[str, float]]
    """Combinations of parameters that the lengths leave open."""
    not_determined: list[str]
    angle_error_rad: float
    """Largest, of the parameters that take part in no lost combination."""
    length_error_mm: float
    """The same for lengths."""
    fresh_length_error_mm: float
    """Largest error of lengths between fresh poses."""


def random_poses(arm: Arm, rng: np.random.Generator, count: int) -> F64:
    """(count, n) encoder angles, uniform in ±π."""
    return rng.uniform(-np.pi, np.pi, (count, arm.n))


def lengths_between(arm: Arm, q_rad: F64, p_rad: F64) -> F64:
    """(N,) mm between the tips in poses (N, n) and (N, n)."""
    distance: F64 = np.linalg.norm(arm.tip(q_rad) - arm.tip(p_rad), axis=1)
    return distance


def length_problem(start: Arm, truth: Arm, rng: np.random.Generator, count: int = LENGTHS) -> _core.Problem:
    """`count` lengths between pairs of random poses, exact for the truth, to be explained from the start."""
    q_rad, p_rad = random_poses(truth, rng, count), random_poses(truth, rng, count)
    problem = _core.Problem(start.core)
    probe = np.zeros(count, dtype=np.int64)
    lengths_mm = lengths_between(truth, q_rad, p_rad)
    problem.add("length", "lengths", q_rad=q_rad, p_rad=p_rad, probe=probe, measured_mm=lengths_mm)
    return problem


def rerun_simulation(seed: int) -> list[Simulated]:
    """With r = 10 mm and with r = 0."""
    return [_simulate(r_mm, np.random.default_rng([seed, number])) for number, r_mm in enumerate((10.0, 0.0))]


def _simulate(r_mm: float, rng: np.random.Generator) -> Simulated:
    truth, start = simulated(r_mm)
    problem = length_problem(start, truth, rng)
    names = truth.parameter_names
    fitted = _core.fit(problem, np.zeros(len(names), dtype=bool))
    found = start.with_parameters(fitted.parameters)
    what = fitted.identifiability
    sure = np.array([name not in what.not_determined for name in names])
    angle = np.array([unit == "rad" for unit in truth.parameter_units])
    error = np.abs(fitted.parameters - truth.parameters)
    q_rad, p_rad = random_poses(truth, rng, FRESH), random_poses(truth, rng, FRESH)
    fresh = lengths_between(found, q_rad, p_rad) - lengths_between(truth, q_rad, p_rad)
    return Simulated(
        r_mm=r_mm,
        converged=fitted.converged,
        iterations=fitted.iterations,
        parameters=what.parameters,
        determined=what.determined,
        lost=[lost["combination"] for lost in what.lost],
        not_determined=what.not_determined,
        angle_error_rad=float(error[sure & angle].max()),
        length_error_mm=float(error[sure & ~angle].max()),
        fresh_length_error_mm=float(np.abs(fresh).max()),
    )
