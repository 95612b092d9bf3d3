"""The experiment on a virtual arm: Table 4 is the truth, the noise is known, and so is what the arm should find."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.probe import Probe
from ulna.ground.arrays import F64, Progress
from ulna.reproduce.cheng2011.arms import (
    BAR_MM,
    BENT_PROBE,
    ENCODER_RAD,
    RATED_MM,
    SEAT_MM,
    STRAIGHT_PROBE,
    platinum,
    virtual,
)
from ulna.simulation.reading_errors import as_drawn

BARS = 101
FRESH_BARS = 10
SEAT_POSES = 32
BAR_ENDS_MM = np.array([[0.0, 0.0, 0.0], [BAR_MM, 0.0, 0.0]])
START_RAD = 0.1
START_MM = 100.0
"""The arm of the start: everything off by up to this, as a drawing might be."""


@dataclass(frozen=True)
class Calibrated:
    """A parameter as published (the virtual truth), as it started and as it was found."""

    name: str
    unit: str
    truth: float
    start: float
    found: float
    u: float | None
    """Standard uncertainty; None where not determined."""


@dataclass(frozen=True)
class Experiment:
    """Both steps: the arm with its bent probe from bars, the straight probe alone from one seat."""

    iterations: int
    converged: bool
    chi2_per_dof: float | None
    rms_mm: float
    """Of the 101 length errors, after."""
    parameters: list[Calibrated]
    straight: list[Calibrated]
    """theta0, r, h of the straight probe."""
    bent_errors_mm: list[float]
    """Of ten fresh bars, by the calibrated arm."""
    straight_errors_mm: list[float]
    bent_errors_true_arm_mm: list[float]
    """Of the same ten bars by the true arm: what noise alone makes."""
    straight_errors_true_arm_mm: list[float]


def rerun_experiment(seed: int) -> Experiment:
    """101 bars with the bent probe, 32 poses in one seat with the straight probe, ten fresh bars with each."""
    rng = np.random.default_rng([seed, 300])
    bent, straight = platinum(BENT_PROBE), platinum(STRAIGHT_PROBE)
    noise = np.full(bent.n, ENCODER_RAD)

    start = as_drawn(bent, rng, START_RAD, START_MM)
    bars_rad = _touch_bars(bent, BARS, seed, rng)
    problem = _core.Problem(start.core, noise, SEAT_MM)
    problem.add(
        "length",
        "bar",
        q_rad=bars_rad[:, 0].copy(),
        p_rad=bars_rad[:, 1].copy(),
        probe=np.zeros(BARS, np.int64),
        measured_mm=np.full(BARS, BAR_MM),
    )
    fitted = _core.fit(problem, np.zeros(len(start.parameters), dtype=bool))
    calibrated = start.with_parameters(fitted.parameters)

    with_straight, probe = _straight_probe(calibrated, straight, seed + 1, rng)
    bent_rad = _touch_bars(bent, FRESH_BARS, seed + 2, rng)
    straight_rad = _touch_bars(straight, FRESH_BARS, seed + 3, rng)
    return Experiment(
        iterations=fitted.iterations,
        converged=fitted.converged,
        chi2_per_dof=fitted.chi2_per_dof,
        rms_mm=fitted.rms_mm,
        parameters=_parameters(bent, start, fitted),
        straight=probe,
        bent_errors_mm=_errors_mm(calibrated, bent_rad),
        straight_errors_mm=_errors_mm(with_straight, straight_rad),
        bent_errors_true_arm_mm=_errors_mm(bent, bent_rad),
        straight_errors_true_arm_mm=_errors_mm(straight, straight_rad),
    )


@dataclass(frozen=True)
class Repeated:
    """The experiment again and again, other bars and other noise each time."""

    repeats: int
    bent_within: int
    """In how many all ten fresh bars stayed within the rated accuracy."""
    straight_within: int
    true_arm_within: int
    """The same for the bent probe by the true arm: noise alone leaves the limit now and then."""
    bent_rms_mm: float
    """Of all fresh bars of all repeats."""
    straight_rms_mm: float
    true_arm_rms_mm: float


def repeat_experiment(seed: int, repeats: int, progress: Progress | None) -> Repeated:
    """`repeats` experiments; that of `rerun_experiment` with the same seed is not among them."""
    errors = np.empty((3, repeats, FRESH_BARS))
    for k in range(repeats):
        if progress is not None:
            progress("experiment", k, repeats)
        found = rerun_experiment(seed + 1000 * (k + 1))
        errors[:, k] = found.bent_errors_mm, found.straight_errors_mm, found.bent_errors_true_arm_mm
    within = (np.abs(errors) <= RATED_MM).all(axis=2).sum(axis=1)
    rms_mm = np.sqrt((errors**2).mean(axis=(1, 2)))
    return Repeated(repeats, *(int(count) for count in within), *(float(value) for value in rms_mm))


def _touch_bars(arm: Arm, count: int, seed: int, rng: np.random.Generator) -> F64:
    """(count, 2, 7) encoder readings with the ball in both seats of a bar that is put in `count` random places."""
    of = virtual(arm)
    ends_mm = of.places(BAR_ENDS_MM, count, rng)
    return of.touch(ends_mm.reshape(-1, 3), seed, rng).reshape(count, 2, arm.n)


def _errors_mm(arm: Arm, bars_rad: F64) -> list[float]:
    """Measured length minus the bar's, for (N, 2, 7) readings."""
    lengths = np.linalg.norm(arm.tip(bars_rad[:, 0]) - arm.tip(bars_rad[:, 1]), axis=1)
    return [float(error) for error in lengths - BAR_MM]


def _parameters(truth: Arm, start: Arm, fitted: _core.Fitted) -> list[Calibrated]:
    u = dict(zip(fitted.covariance_columns.tolist(), np.sqrt(np.diag(fitted.covariance)).tolist(), strict=True))
    lost = set(fitted.identifiability.not_determined)
    rows = zip(truth.parameter_names, truth.parameter_units, truth.parameters, start.parameters, strict=True)
    return [
        Calibrated(name, unit, float(is_), float(was), float(fitted.parameters[k]), None if name in lost else u[k])
        for k, (name, unit, is_, was) in enumerate(rows)
    ]


def _straight_probe(calibrated: Arm, truth: Arm, seed: int, rng: np.random.Generator) -> tuple[Arm, list[Calibrated]]:
    """The second step: joints held as calibrated, the straight probe alone from poses in one seat."""
    guess = Probe(0.0, 0.0, 220.0)
    start = replace(calibrated, probes={"bent": guess})
    of = virtual(truth)
    seat_mm = of.places(BAR_ENDS_MM, 1, rng)[0, :1]  # one place within reach
    q_rad = of.touch(np.repeat(seat_mm, SEAT_POSES, axis=0), seed, rng)
    problem = _core.Problem(start.core, np.full(truth.n, ENCODER_RAD), SEAT_MM)
    none = np.zeros(SEAT_POSES, dtype=np.int64)
    cone_mm = np.zeros((1, 3))
    problem.add("points", "cone", features_mm=cone_mm, q_rad=q_rad, probe=none, feature=none, placement=none)
    hold = np.array([not name.startswith("probe.") for name in start.parameter_names])
    fitted = _core.fit(problem, hold)
    x, y, z = fitted.parameters[-3:]
    theta0_rad, r_mm, h_mm = Probe(float(x), float(y), float(z)).cylindrical
    # x = r cos(theta0), y = -r sin(theta0), z = h
    by_tip = np.array([[y / r_mm**2, -x / r_mm**2, 0.0], [x / r_mm, y / r_mm, 0.0], [0.0, 0.0, 1.0]])
    u = np.sqrt(np.diag(by_tip @ fitted.covariance @ by_tip.T))
    found = (theta0_rad, r_mm, h_mm)
    names = (("theta0", "rad"), ("r", "mm"), ("h", "mm"))
    rows = zip(names, truth.probes["bent"].cylindrical, guess.cylindrical, found, u.tolist(), strict=True)
    probe = [Calibrated(f"probe.straight.{name}", unit, *values) for (name, unit), *values in rows]
    return start.with_parameters(fitted.parameters), probe
