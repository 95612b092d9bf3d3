"""One calibration of a virtual arm by one way, and how right the arm is that it finds."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.readings import Readings
from ulna.calibration.calibrate import calibrate as run_calibrate
from ulna.calibration.estimators import search_box
from ulna.calibration.result import Result
from ulna.geometry.rigid import placed
from ulna.ground.arrays import F64
from ulna.reproduce.cheng2011.arms import ENCODER_RAD, SEAT_MM
from ulna.reproduce.ways.arms import BAR_ENDS_MM, BAR_MM
from ulna.simulation.reading_errors import as_drawn
from ulna.simulation.virtual_arm import VirtualArm
from ulna.study.assembly import assemble
from ulna.study.data import FitOptions, Noise
from ulna.study.study import Study

WRONG_RAD, WRONG_MM = 0.1, 2.0
"""How far off the drawing is that every calibration starts from: zero offsets, and lengths. Twists are right angles."""

BUDGET = 100_000
"""Evaluations that a search without derivatives may use."""

FRESH_BARS = 50
FRESH_POINTS = 1000


@dataclass(frozen=True)
class Trial:
    """A calibration that was carried out."""

    truth: VirtualArm
    start: Arm
    readings: Readings
    arm: Arm
    """As found."""
    seconds: float
    """Of the calibration alone."""
    result: Result | None
    """None where nothing but a search without derivatives was run, which says nothing of uncertainty."""

    @property
    def touches(self) -> int:
        """Poses that were read."""
        return len(self.readings) * (1 if self.readings.p_rad is None else 2)

    @property
    def off_over_u(self) -> list[float]:
        """Error of each determined parameter, in its standard uncertainties."""
        if self.result is None:
            return []
        true = dict(zip(self.truth.arm.parameter_names, self.truth.arm.parameters.tolist(), strict=True))
        rows = self.result.parameters
        return [(row.value - true[row.name]) / row.u for row in rows if row.u and row.status == "fitted"]


@dataclass(frozen=True)
class Errors:
    """What an arm measures that it was not calibrated by."""

    bars_mm: F64
    """(FRESH_BARS,) errors of lengths, read with the noise of the calibration."""
    bars_by_arm_mm: F64
    """(FRESH_BARS,) what the arm contributes to them: the same places, noiseless."""
    worst_point_mm: float
    """Of FRESH_POINTS noiseless poses anywhere, the farthest from the true point after the best rigid motion."""


#: a way of calibrating: the true arm and a seed → what came out
CarryOut = Callable[[VirtualArm, int], Trial]


def start_of(truth: VirtualArm, seed: int) -> Arm:
    """The drawing of the arm."""
    return as_drawn(truth.arm, np.random.default_rng([seed, 1]), WRONG_RAD, WRONG_MM)


def study_of(start: Arm, readings: Readings, **fit: Any) -> Study:
    """A study as a user would state it, the noise known."""
    noise = Noise(np.full(start.n, ENCODER_RAD), SEAT_MM)
    return Study(None, start, [readings], noise=noise, fit=FitOptions(**fit))


def calibrate(truth: VirtualArm, start: Arm, readings: Readings, **fit: Any) -> Trial:
    """Calibrate by these readings."""
    study = study_of(start, readings, budget=BUDGET, **fit)
    began = time.perf_counter()
    result = run_calibrate(study)
    return Trial(truth, start, readings, result.arm, time.perf_counter() - began, result)


def search_alone(truth: VirtualArm, start: Arm, readings: Readings, **fit: Any) -> Trial:
    """Only the search without derivatives, not finished by Levenberg–Marquardt."""
    study = study_of(start, readings, budget=BUDGET, **fit)
    began = time.perf_counter()
    found = search_box(study, assemble(study))
    return Trial(truth, start, readings, start.with_parameters(found.parameters), time.perf_counter() - began, None)


def errors_of(arm: Arm, truth: VirtualArm, seed: int) -> Errors:
    """Of fresh bars and fresh points, the same for every way with the same seed."""
    rng = np.random.default_rng([seed, 2])
    ends_mm = truth.places(BAR_ENDS_MM, FRESH_BARS, rng)
    q_rad = truth.touch(ends_mm.reshape(-1, 3), seed, rng)
    length_mm, true_length_mm = _lengths_mm(arm, q_rad), _lengths_mm(truth.arm, q_rad)
    anywhere = truth.anywhere(FRESH_POINTS, rng)
    true_mm, found_mm = truth.arm.tip(anywhere), arm.tip(anywhere)
    over_mm = placed(found_mm, true_mm, np.zeros(len(true_mm), dtype=np.int64))
    return Errors(
        bars_mm=length_mm - BAR_MM,
        bars_by_arm_mm=length_mm - true_length_mm,
        worst_point_mm=float(np.linalg.norm(over_mm - true_mm, axis=1).max()),
    )


def _lengths_mm(arm: Arm, q_rad: F64) -> F64:
    ends_mm = arm.tip(q_rad).reshape(-1, 2, 3)
    lengths: F64 = np.linalg.norm(ends_mm[:, 1] - ends_mm[:, 0], axis=1)
    return lengths
