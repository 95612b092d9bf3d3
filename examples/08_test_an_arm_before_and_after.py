"""Test an arm before and after: an acceptance test from plain coordinates, as found and as left, in one report.

An arm plays a short test. As found, the encoder of its third joint had slipped by 0.1 mrad since the last calibration;
as left, that is corrected. What is evaluated are x, y, z, as any arm's software gives them: whose make the arm is
does not matter.
"""

import tempfile
from pathlib import Path

import numpy as np
import polars as pl

import ulna
from ulna.verification.test_plan import play_test_plan

TRUTH = ulna.Arm.load(Path(__file__).parent / "platinum" / "truth.toml")
ANGLES = [f"q{k + 1}" for k in range(TRUTH.n)]
SHORT = """
format = "ulna-profile/1"
name = "short"
based_on = "iso-10360-12"
without = ["bi"]
[test.uni]
lengths = 3
positions = 4
repeats = 1
"""
FOUND = """
[[readings]]
file = "as-found.csv"
state = "as-found"
"""


def slipped(arm: ulna.Arm, by_rad: float) -> ulna.Arm:
    """The arm whose third encoder is off."""
    parameters = arm.parameters.copy()
    parameters[arm.parameter_names.index("joint.3.theta0")] += by_rad
    return arm.with_parameters(parameters)


def coordinates(touches: pl.DataFrame, arm: ulna.Arm) -> pl.DataFrame:
    """The touches as an arm's software would give them, to 0.1 µm."""
    p_mm = np.round(arm.tip(touches.select(ANGLES).to_numpy()), 4)
    return touches.drop(ANGLES).with_columns(pl.Series(axis, p_mm[:, k]) for k, axis in enumerate("xyz"))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "short.toml").write_text(SHORT, encoding="utf-8")
        plan = play_test_plan("short.toml", TRUTH, seed=8, beside=folder)
        text = plan.text(folder).replace("\nrange =", "\nball = 6.0\nrange =")
        (folder / "plan.toml").write_text(text + FOUND, encoding="utf-8")
        coordinates(plan.table, TRUTH).write_csv(folder / "touches.csv")
        coordinates(plan.table, slipped(TRUTH, 1e-4)).write_csv(folder / "as-found.csv")
        tested = ulna.verify(folder / "plan.toml")
    for state in tested.states:
        print(f"{state.state}: {state.verdict}")
        for figure in state.figures.values():
            worst = figure.worst
            assert worst.limit_mm is not None
            print(
                f"  {figure.definition.name:26} {1000 * worst.single.value_mm:7.1f} µm"
                f"   limit {1000 * worst.limit_mm:5.1f} µm   {figure.verdict}"
            )
