"""The plan put to the test: calibrations on its readings and on random ones, noise drawn anew, fresh bars measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ulna.cores import available_cores
from ulna.model import Arm
from ulna.plan_spec import PlanSpec
from ulna.planning.candidates import Candidates

if TYPE_CHECKING:
    from ulna import _core

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]


@dataclass(frozen=True)
class Trial:
    """Errors of the lengths of fresh bars, read without noise by calibrated arms: what the arm contributes."""

    runs: int
    """Calibrations on the plan, and as many on random measurements."""
    planned_mm: float
    """Root mean square over calibrations and bars."""
    random_mm: float
    converged: int
    """Of twice as many runs."""

    @property
    def gain(self) -> float:
        """By which part the errors are smaller."""
        return 1.0 - self.planned_mm / self.random_mm


def problem_of(arm: Arm, spec: PlanSpec, probe: int, taken: Candidates) -> _core.Problem:
    """The core's problem of these measurements, each a placement of its own, readings exact."""
    from ulna import _core

    q_rad = taken.poses(np.arange(len(taken)))
    count, features, touches, n = q_rad.shape
    per = features * touches
    problem = _core.Problem(arm.core, spec.encoder_rad, spec.seat_mm)
    problem.add_points(
        spec.artefact.name,
        np.array(list(spec.artefact.features.values()), dtype=np.float64),
        spec.artefact.frame,
        np.ascontiguousarray(q_rad.reshape(-1, n)),
        np.full(count * per, probe, dtype=np.int64),
        np.tile(np.repeat(np.arange(features), touches), count),
        np.repeat(np.arange(count), per),
    )
    return problem


def carry_out(
    arm: Arm, spec: PlanSpec, probe: int, free: I64, sets: list[Candidates], bars_rad: F64, runs: int, seed: int
) -> tuple[float, int]:
    """Root mean square error (mm) of the (B, 2, n) bars by arms calibrated on these sets in turn, and how many of the
    `runs` calibrations converged."""
    from ulna import _core

    hold = np.ones(len(arm.parameter_names), dtype=bool)
    hold[free] = False
    flat = np.ascontiguousarray(bars_rad.reshape(-1, arm.n))

    def lengths(core: _core.Arm) -> F64:
        ends = core.tip(flat, probe).reshape(-1, 2, 3)
        distance: F64 = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return distance

    true_mm = lengths(arm.core)
    squares, good = [], 0
    for number, taken in enumerate(sets):
        problem = problem_of(arm, spec, probe, taken)
        own = runs // len(sets) + (number < runs % len(sets))
        parameters, _, converged = _core.recalibrate(
            problem, hold, arm.core, own, seed=seed + number, threads=available_cores(), uncertainties=False
        )
        good += int(converged.sum())
        squares += [np.mean((lengths(arm.core.with_parameters(row)) - true_mm) ** 2) for row in parameters]
    return float(np.sqrt(np.mean(squares))), good
