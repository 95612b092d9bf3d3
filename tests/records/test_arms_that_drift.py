"""Histories of a virtual arm that is calibrated every year, each time by readings with noise of their own: one that
stands still is said to drift as often as is stated, one that drifts is found as often as the noncentral t says."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import ulna
from ulna import Study
from ulna.calibration.recalibrations import recalibrations
from ulna.control.drift import drift
from ulna.records.records import Records

HISTORIES, YEARS = 1000, 6
STEP_RAD = 10e-6
NAME = "joint.4.theta0"


@pytest.fixture(scope="module")
def study(root: Path) -> Study:
    return Study.load(root / "examples" / "platinum" / "study.toml")


def histories(study: Study, step_rad: float) -> tuple[np.ndarray, float]:
    """(HISTORIES, YEARS) of the joint's zero as it was found each year, rad, and its stated u."""
    result = ulna.calibrate(study)
    at = result.arm.parameter_names.index(NAME)
    found = np.empty((HISTORIES, YEARS))
    for year in range(YEARS):
        now = result.arm.parameters.copy()
        now[at] += year * step_rad
        drawn = recalibrations(study, result.arm.with_parameters(now), HISTORIES + 20, seed=100 + year)
        found[:, year] = drawn.parameters[drawn.converged][:HISTORIES, at]
    (u,) = (row.u for row in result.parameters if row.name == NAME)
    assert u is not None
    return found, u


def share_found(values: np.ndarray, u: float) -> float:
    days = 365.25 * np.arange(YEARS)
    return float(np.mean([bool(drift(days, row, [u] * YEARS).drifts) for row in values]))


def test_an_arm_that_stands_still_is_said_to_drift_one_time_in_twenty(study: Study) -> None:
    values, u = histories(study, 0.0)
    assert values.std(ddof=1) == pytest.approx(u, rel=0.05)
    assert share_found(values, u) == pytest.approx(0.05, abs=0.015)


def test_one_that_drifts_is_found_as_often_as_it_can_be(study: Study) -> None:
    values, u = histories(study, STEP_RAD)
    spread = math.sqrt(((np.arange(YEARS) - (YEARS - 1) / 2) ** 2).sum())
    beyond = stats.t(YEARS - 2).ppf(0.975)
    power = stats.nct(YEARS - 2, STEP_RAD * spread / u).sf(beyond)
    assert 0.3 < power < 0.99
    assert share_found(values, u) == pytest.approx(power, abs=0.04)


def test_the_record_knows_a_parameter_over_time(tmp_path: Path, root: Path) -> None:
    text = json.loads((root / "tests/data/fossils/result-1.json").read_text())
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7")
    name = next(row["name"] for row in text["parameters"] if row["status"] == "fitted" and row["u"])
    for year in range(5):
        path = tmp_path / f"{year}.json"
        path.write_text(json.dumps(text) + " " * year)
        records.add(path, arm="P7", at=f"{2020 + year}-03-01")
    found = records.trend("P7", name)
    (row,) = (row for row in text["parameters"] if row["name"] == name)
    assert [(each.value, each.u, each.unit) for each in found.points] == [(row["value"], row["u"], row["unit"])] * 5
    assert not found.drift.drifts
