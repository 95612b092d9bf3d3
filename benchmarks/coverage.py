"""``python -m benchmarks.coverage``: how often stated intervals hold the truth, over simulated arms.

Each arm is calibrated from a bar in 140 places with its own noise; then a point, a length and a ball are measured with
fresh noise. Prints the share of parameters, coordinates, lengths and diameters whose 95 % interval holds the truth, by
the first order and by Monte Carlo. Options: --arms N, --trials N (of Monte Carlo for each measurement; 0: none).
"""

import argparse
import sys

import numpy as np

import ulna
from ulna.model import Arm
from ulna.reproduce.ways import readings, trial
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.uncertainty.assess import Assessment, assess
from ulna.uncertainty.measurands import Touched
from ulna.uncertainty.regions import contains
from ulna.uncertainty.task import Task
from ulna.virtual.arm import VirtualArm

BALL_MM = 30.0
TOUCHES = 25

#: kind → true positions that are touched, (N, 3) mm, and the feature of each
Touches = tuple[np.ndarray, list[int]]


def touches(kind: str, truth: VirtualArm, seed: int, rng: np.random.Generator) -> Touches:
    """Somewhere in the volume, at another place for each seed."""
    if kind == "point":
        return truth.arm.tip(truth.poses(1, rng)), [0]
    if kind == "length":
        ends = np.array([[0.0, 0.0, 0.0], [rng.uniform(100.0, 700.0), 0.0, 0.0]])
        return truth.places(ends, 1, seed, rng)[0], [0, 1]
    direction = rng.standard_normal((TOUCHES, 3))
    direction[:, 2] = np.abs(direction[:, 2])
    ball = 0.5 * BALL_MM * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return truth.places(ball, 1, seed, rng)[0], [0] * TOUCHES


def measured(kind: str, arm: Arm, truth: VirtualArm, seed: int, trials: int) -> tuple[np.ndarray, Assessment]:
    """The true values, and what is said of the measured ones."""
    rng = np.random.default_rng([seed, len(kind)])
    at_mm, feature = touches(kind, truth, seed, rng)
    touched = Touched(kind, np.array(feature))
    q_rad = truth.touch(at_mm, seed, rng)
    task = Task(touched, q_rad, "bent", kind, truth.errors.encoder_rad, truth.errors.seat_mm)
    found = assess(arm, task, seed=seed, most_trials=trials)
    return touched.values(at_mm[None])[0], found


def shares(arms: int, trials: int) -> dict[str, float]:
    """What → share of intervals that hold the truth."""
    truth = true_arm(SEVEN)
    true = dict(zip(truth.arm.parameter_names, truth.arm.parameters.tolist(), strict=True))
    held: dict[str, list[bool]] = {}
    for seed in range(1, arms + 1):
        study = trial.study_of(trial.start_of(truth, seed), readings.bars(truth, seed))
        result = ulna.calibrate(study)
        rows = [row for row in result.parameters if row.u]
        held.setdefault("parameters", []).extend(
            abs(row.value - true[row.name]) < 1.96 * row.u for row in rows if row.u
        )
        for kind in ("point", "length", "ball"):
            values, found = measured(kind, result.arm, truth, seed, trials)
            for value, really in zip(found.values, values.tolist(), strict=True):
                what = {"length": "lengths", "diameter": "diameters"}.get(value.name, f"{kind} coordinates")
                expanded = value.expanded_mm or 0.0
                held.setdefault(what, []).append(abs(value.value_mm - really) < expanded)
                if value.monte_carlo is not None:
                    # the interval about the value as it was measured
                    low, high = value.monte_carlo.symmetric
                    held.setdefault(f"{what}, Monte Carlo", []).append(low < really < high)
            if found.region is not None:
                inside = contains(found.region, values[None])[0]
                held.setdefault("points, ellipsoid", []).append(bool(inside))
    return {what: float(np.mean(each)) for what, each in held.items()}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coverage", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--arms", type=int, default=1000)
    parser.add_argument("--trials", type=int, default=20_000)
    given = parser.parse_args()
    print(f"{given.arms} simulated arms, 95 % intervals that hold the truth:", file=sys.stderr)
    for what, share in shares(given.arms, given.trials).items():
        print(f"{what:32s} {100 * share:5.1f} %")


if __name__ == "__main__":
    main()
