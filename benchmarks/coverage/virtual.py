"""``python -m benchmarks.coverage``: how often stated intervals hold the truth, over simulated arms.

Each arm is calibrated from a bar in 140 places with its own noise; then a point, a length and a ball are measured with
fresh noise. Writes docs/benchmarks/coverage.md: the share of parameters, coordinates, lengths and diameters whose 95 %
interval holds the truth: by the first order, by Monte Carlo with parameters drawn from the covariance, and with whole
calibrations redrawn (of the bar's lengths alone there, so that it takes minutes).
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import ulna
from ulna.arm.arm import Arm
from ulna.arm.reading_noise import ReadingNoise
from ulna.calibration.recalibrations import recalibrations
from ulna.reproduce.ways import readings, trial
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.simulation.virtual_arm import VirtualArm
from ulna.study.study import Study
from ulna.uncertainties.assess import Assessment, assess
from ulna.uncertainties.measurands import Touched
from ulna.uncertainties.regions import contains
from ulna.uncertainties.task import Task

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks" / "coverage.md"
BALL_MM = 30.0
TOUCHES = 25

#: kind → true positions that are touched, (N, 3) mm, and the feature of each
Touches = tuple[np.ndarray, list[int]]


def touches(kind: str, truth: VirtualArm, seed: int, rng: np.random.Generator) -> Touches:
    """Somewhere in the volume, at another place for each seed."""
    if kind == "point":
        return truth.arm.tip(truth.anywhere(1, rng)), [0]
    if kind == "length":
        ends = np.array([[0.0, 0.0, 0.0], [rng.uniform(100.0, 700.0), 0.0, 0.0]])
        return truth.places(ends, 1, rng)[0], [0, 1]
    direction = rng.standard_normal((TOUCHES, 3))
    direction[:, 2] = np.abs(direction[:, 2])
    ball = 0.5 * BALL_MM * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return truth.places(ball, 1, rng)[0], [0] * TOUCHES


def measured(
    kind: str, arm: Arm, truth: VirtualArm, seed: int, trials: int, study: Study | None = None
) -> tuple[np.ndarray, Assessment]:
    """The true values, and what is said of the measured ones."""
    rng = np.random.default_rng([seed, len(kind)])
    at_mm, feature = touches(kind, truth, seed, rng)
    touched = Touched(kind, np.array(feature))
    q_rad = truth.touch(at_mm, seed, rng)
    task = Task(touched, q_rad, "bent", kind, ReadingNoise(truth.errors.encoder_rad, truth.errors.seat_mm))
    found = assess(arm, task, study=study, seed=seed, most_trials=trials)
    return touched.values(at_mm[None])[0], found


Held = dict[str, list[bool]]


def by_covariance(truth: VirtualArm, seed: int, trials: int, held: Held) -> None:
    """One arm: first order, and Monte Carlo with parameters from the covariance."""
    true = dict(zip(truth.arm.parameter_names, truth.arm.parameters.tolist(), strict=True))
    result = ulna.calibrate(trial.study_of(trial.start_of(truth, seed), readings.bars(truth, seed)))
    rows = [row for row in result.parameters if row.u]
    held.setdefault("parameters", []).extend(abs(row.value - true[row.name]) < 1.96 * row.u for row in rows if row.u)
    for kind in ("point", "length", "ball"):
        values, found = measured(kind, result.arm, truth, seed, trials)
        for value, really in zip(found.values, values.tolist(), strict=True):
            what = {"length": "lengths", "diameter": "diameters"}.get(value.name, f"{kind} coordinates")
            held.setdefault(what, []).append(abs(value.value - really) < (value.expanded or 0.0))
            if value.monte_carlo is not None:
                low, high = value.monte_carlo.symmetric
                held.setdefault(f"{what}, Monte Carlo", []).append(low < really < high)
        if found.region is not None:
            held.setdefault("points, ellipsoid", []).append(bool(contains(found.region, values[None])[0]))


def by_calibrations(truth: VirtualArm, seed: int, runs: int, held: Held) -> None:
    """One arm: whole calibrations redrawn."""
    bar = readings.lengths_alone(readings.ball_bar(truth, seed))
    study = trial.study_of(trial.start_of(truth, seed), bar)
    result = ulna.calibrate(study)
    again = recalibrations(study, result.arm, runs, seed)
    ends = np.quantile(again.parameters, (0.025, 0.975), axis=0)
    for column, (name, really) in enumerate(zip(truth.arm.parameter_names, truth.arm.parameters, strict=True)):
        if np.isfinite(again.u[:, column]).all():
            assert again.names[column] == name
            inside = bool(ends[0, column] < really < ends[1, column])
            held.setdefault("parameters, calibrations redrawn", []).append(inside)
    for kind in ("point", "length"):
        values, found = measured(kind, result.arm, truth, seed, runs, study)
        for value, really in zip(found.values, values.tolist(), strict=True):
            what = "lengths" if kind == "length" else "point coordinates"
            if value.monte_carlo is not None:
                low, high = value.monte_carlo.symmetric
                held.setdefault(f"{what}, calibrations redrawn", []).append(low < really < high)


def shares(arms: int, trials: int, runs: int) -> dict[str, float]:
    """What → share of intervals that hold the truth."""
    truth = true_arm(SEVEN)
    held: Held = {}
    for seed in range(1, arms + 1):
        by_covariance(truth, seed, trials, held)
        by_calibrations(truth, seed, runs, held)
        if seed % 50 == 0:
            print(f"{seed} of {arms} arms", file=sys.stderr)
    return {
        what: float(np.mean(held[what])) for what in sorted(held, key=lambda what: what.split(",")[0] != "parameters")
    }


def page(found: dict[str, float], arms: int, trials: int, runs: int) -> str:
    """Markdown."""
    lines = [
        "<!-- Generated by `python -m benchmarks.coverage`; do not edit. -->\n",
        f"Share of {arms:,} arms in %; Monte Carlo of {trials:,} trials for each measurement, or of {runs:,} whole "
        "calibrations:\n",
        "| | first order | Monte Carlo | calibrations redrawn |",
        "|---|---:|---:|---:|",
    ]
    for what in dict.fromkeys(name.split(",")[0] for name in found if name != "points, ellipsoid"):
        each = (what, f"{what}, Monte Carlo", f"{what}, calibrations redrawn")
        lines.append(
            f"| {what} | " + " | ".join(f"{100 * found[key]:.1f}" if key in found else "–" for key in each) + " |"
        )
    lines.append(f"| points, ellipsoid | {100 * found['points, ellipsoid']:.1f} | – | – |")
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str]) -> None:
    """Measure, print, and write the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coverage", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--arms", type=int, default=1000)
    parser.add_argument("--trials", type=int, default=10_000, help="of Monte Carlo, for each measurement")
    parser.add_argument("--runs", type=int, default=2000, help="calibrations redrawn, for each arm")
    given = parser.parse_args(arguments)
    text = page(shares(given.arms, given.trials, given.runs), given.arms, given.trials, given.runs)
    print(text)
    PAGE.write_text(text, encoding="utf-8")
    print(f"written: {PAGE.name}", file=sys.stderr)
