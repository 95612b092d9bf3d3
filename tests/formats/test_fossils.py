"""One sample of each released format, never changed again: what they say must arrive forever."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from ulna import Arm, InputWarning, Result, Study
from ulna.artefacts.readings import Readings
from ulna.calibration.result_file import CrossValidationFile, EvaluationFile, ResultFile
from ulna.study.assembly import assemble

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"
TURN = 2 * math.pi / 163840


def test_arm_1() -> None:
    arm = Arm.load(FOSSILS / "arm-1.toml")
    assert (arm.name, arm.n, list(arm.probes)) == ("a fossil of every key", 4, ["bent", "straight 2"])
    first, second, third, last = arm.joints
    assert (first.name, first.sign, first.model, first.counts_per_turn) == ("shoulder", -1, "dh", 163840)
    assert first.theta0_rad == pytest.approx(math.radians(87.2))
    assert first.alpha_rad == pytest.approx(math.radians(-90.1))
    assert (first.a_mm, first.d_mm) == pytest.approx((1.67 * 25.4, 5.9 * 25.4))
    assert first.limits_rad == pytest.approx((math.radians(-170), math.radians(170)))
    assert (second.model, second.d_mm) == ("hayati", 0.0)
    assert second.beta_rad == pytest.approx(math.radians(0.05))
    assert third.d_mm == pytest.approx(17.3 * 25.4)
    assert (last.name, last.theta0_rad, last.a_mm) == ("wrist roll", 0.0, 0.0)
    theta0_rad, r_mm, h_mm = arm.probes["bent"].cylindrical
    assert (theta0_rad, r_mm, h_mm) == pytest.approx((math.radians(24.7), 1.55 * 25.4, 8.81 * 25.4))
    assert arm.probes["bent"].ball_mm == pytest.approx(6.35)
    assert arm.probes["straight 2"].tip_mm == pytest.approx(np.array([0.001, -0.002, 9.4]) * 25.4)


def test_arm_1_in_the_modified_form() -> None:
    arm = Arm.load(FOSSILS / "arm-1-modified.toml")
    first, second, last = arm.joints
    assert (first.theta0_rad, first.alpha_rad) == pytest.approx((math.radians(12.5), -math.pi / 2))
    assert (first.a_mm, first.d_mm, second.a_mm, second.d_mm) == pytest.approx((82.5, 333.0, -82.5, 0.0))
    assert (second.theta0_rad, second.alpha_rad) == pytest.approx((math.radians(-3.25), math.pi / 2))
    assert (second.sign, last.theta0_rad, last.d_mm) == (-1, 0.0, 0.0)
    turned = (40 * math.cos(math.radians(30)), -40 * math.sin(math.radians(30)), 107.0 + 103.4)
    assert arm.probes["straight"].tip_mm == pytest.approx(np.array(turned))


@pytest.fixture(scope="module")
def study() -> Study:
    return Study.load(FOSSILS / "study-1.toml")


def _group(study: Study, name: str) -> Readings:
    return next(group for group in study.readings if group.artefact.name == name)


def test_study_1(study: Study) -> None:
    assert study.warnings == []
    assert [group.artefact.name for group in study.readings] == ["bar", "cone", "plate", "corner", "distance"]
    assert study.noise is not None
    assert study.noise.seat_mm == pytest.approx(0.0002 * 25.4)
    assert study.noise.encoder_rad == pytest.approx(np.radians([0.0003, 0.0003, 0.0003, 0.0005]))
    assert (study.fit.start, study.fit.seed, study.fit.max_iterations) == ("search", 3, 50)
    assert study.fit.known_length_mm == pytest.approx(0.04 * 25.4)
    assert study.fit.known_angle_rad == pytest.approx(math.radians(0.5))
    assembled = assemble(study)
    held = [name for name, hold in zip(assembled.names, assembled.hold, strict=True) if hold]
    assert held == ["joint.1.theta0", "probe.straight 2.x", "probe.straight 2.y", "probe.straight 2.z"]
    assert [(file.path.name, file.rows) for file in study.files] == [
        ("study-1.toml", 0),
        ("arm-1.toml", 0),
        ("plate-1.csv", 3),
        ("readings-1.csv", 4),
        ("readings-1.parquet", 2),
        ("lengths-1.csv", 2),
    ]


def test_readings_1_csv(study: Study) -> None:
    bar = _group(study, "bar")
    assert bar.q_rad == pytest.approx(np.array([[1024, -2048, 4096, 512], [1124, -2148, 4196, -512]]) * TURN)
    assert (bar.artefact.length_mm, bar.artefact.u_mm) == pytest.approx((17.4477 * 25.4, 0.0001 * 25.4))
    assert (bar.feature.tolist(), bar.probe.tolist(), bar.row.tolist()) == ([0, 1], [0, 0], [1, 2])
    assert bar.placement.tolist() == ["north", "north"]
    assert bar.id is not None
    assert bar.id.tolist() == ["r1", "r2"]
    assert bar.temperature_c is not None
    assert bar.temperature_c.tolist() == [[20.1, 20.2, 20.3, 20.4]] * 2
    cone, corner = _group(study, "cone"), _group(study, "corner")
    assert (cone.artefact.kind, cone.probe.tolist(), cone.row.tolist()) == ("seat", [1], [3])
    assert (corner.artefact.frame, corner.feature.tolist(), corner.row.tolist()) == ("arm", [1], [4])
    assert corner.artefact.features["c2"] == pytest.approx((4.5 * 25.4, 5.5 * 25.4, 6.5 * 25.4))


def test_readings_1_parquet_and_plate(study: Study) -> None:
    plate = _group(study, "plate")
    assert plate.q_rad == pytest.approx(np.radians(np.array([[10, -10, 3, 0], [20.5, 5.25, 4, 90]])))
    assert (plate.feature.tolist(), plate.probe.tolist()) == ([0, 2], [1, 1])
    assert plate.placement.tolist() == ["on the table"] * 2
    assert plate.temperature_c is not None
    assert plate.temperature_c.tolist() == [20, 21]
    assert plate.artefact.features["s3"] == pytest.approx((0, 4 * 25.4, 0.1 * 25.4))
    assert plate.artefact.feature_u_mm == pytest.approx([0.00004 * 25.4] * 3)


def test_lengths_1(study: Study) -> None:
    distance = _group(study, "distance")
    assert distance.q_rad[1].tolist() == [-0.1, 0.2, -0.3, 0.4]
    assert distance.p_rad is not None
    assert distance.p_rad[1].tolist() == [-1.1, 1.2, -1.3, 1.4]
    assert distance.length_mm == pytest.approx(np.full(2, 17.4477 * 25.4))


def test_study_1_of_other_peoples_tables() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        fitted, kept = (Study.load(FOSSILS / "study-1-tables.toml", rows) for rows in ("fit", "check"))  # type: ignore[arg-type]
    tracker, plate = fitted.readings
    assert tracker.row.tolist() == [1, 6]  # 2: lost, 4: too warm; 3 and 5: to check
    assert tracker.q_rad == pytest.approx(np.radians([[10.5, -10.25, 3.125, 0], [15.5, -15.25, 8.125, 5]]))
    assert list(tracker.artefact.features) == ["p1", "p6"]
    assert tracker.artefact.features["p6"] == pytest.approx((16.5 * 25.4, -7.25 * 25.4, 11.75 * 25.4))
    assert (tracker.artefact.frame, tracker.probe.tolist()) == ("arm", [0, 0])
    assert plate.q_rad == pytest.approx(np.radians([[10, -10, 3, 0], [20.5, 5.25, 4, 90]]))
    assert (plate.feature.tolist(), plate.probe.tolist()) == ([0, 1], [1, 1])
    assert plate.artefact.features["s3"] == pytest.approx((12.7, 4 * 25.4, 0.125 * 25.4))
    (checked,) = kept.readings
    assert checked.row.tolist() == [3, 5]


def test_result_1() -> None:
    path = FOSSILS / "result-1.json"
    ResultFile.model_validate_json(path.read_text())
    result = Result.load(path)
    assert (result.fit.converged, result.fit.readings, len(result.residuals)) == (True, 78, 78)
    assert result.identifiability.determined == 17
    assert [row.status for row in result.parameters[:4]] == ["held", "fitted", "fitted", "not-determined"]
    assert result.after["length_error_max_abs_mm"] == pytest.approx(0.01479, abs=1e-5)
    arm = Arm.load(path)
    assert arm == result.arm
    assert [joint.model for joint in arm.joints] == ["dh", "dh", "hayati", "dh", "dh"]
    assert arm.joints[0].a_mm == pytest.approx(40.7, abs=1.5)
    assert arm.probes["bent"].ball_mm == 6.0
    assert arm.uncertainty is not None
    assert arm.uncertainty.matrix.shape == (len(arm.uncertainty.names),) * 2
    lost = {name for direction in arm.uncertainty.lost for name in direction["combination"]}
    assert lost == {"joint.1.d", "probe.straight.x", "probe.straight.y", "probe.straight.z"}


def test_evaluation_1_and_cross_validation_1() -> None:
    evaluation = EvaluationFile.model_validate_json((FOSSILS / "evaluation-1.json").read_text())
    assert len(evaluation.artefacts) == 12
    assert evaluation.overall.seat_scatter_mean_mm == pytest.approx(0.011965, abs=1e-6)
    found = CrossValidationFile.model_validate_json((FOSSILS / "cross-validation-1.json").read_text())
    assert len(found.groups) == 3
    assert found.after.seat_scatter_mean_mm is not None
    assert found.before.seat_scatter_mean_mm is not None
    assert found.after.seat_scatter_mean_mm < found.before.seat_scatter_mean_mm


def test_what_is_written_today_is_still_of_version_1(tmp_path: Path) -> None:
    old = Result.load(FOSSILS / "result-1.json")
    old.save(tmp_path)
    again = Result.load(tmp_path / "result.json")
    ResultFile.model_validate_json((tmp_path / "result.json").read_text())
    assert again.arm == old.arm
    assert Arm.load(tmp_path / "arm.toml") == old.arm
    assert again.residuals.equals(old.residuals)


def test_arm_1_beyond_geometry() -> None:
    arm = Arm.load(FOSSILS / "arm-1-effects.toml")
    first, second, last = arm.joints
    degree = math.radians(1)
    assert (arm.full_last_link, arm.gravity, first.sign) == (True, (0.1, 0.0, -2.0), 0)
    assert first.effects.harmonics_rad == {
        1: pytest.approx((0.01 * degree, -0.02 * degree)),
        3: pytest.approx((0.0, 0.005 * degree)),
    }
    assert first.effects.expansion_per_k == 1.2e-5
    assert first.effects.compliance_rad_per_nm == pytest.approx(0.001 * degree)
    assert (first.effects.mass_kg, second.effects.mass_kg, last.effects.mass_kg) == (4.5, 2.0, 0.0)
    assert first.effects.centre_mm == pytest.approx((25.4, 50.8, 76.2))
    assert last.effects.harmonics_rad == {2: pytest.approx((0.01 * degree, 0.0))}
    assert (last.theta0_rad, last.d_mm) == pytest.approx((5 * degree, 1.5 * 25.4))


def test_study_1_of_every_way() -> None:
    study = Study.load(FOSSILS / "study-1-ways.toml")
    ball, hollow, flat, bar = (group.artefact for group in study.readings)
    assert (ball.kind, ball.fitted, ball.inside, ball.diameter_mm) == ("sphere", True, False, pytest.approx(50.8))
    assert (hollow.inside, hollow.fitted, flat.kind, bar.fitted) == (True, False, "plane", True)
    assert ball.u_mm == pytest.approx(0.0001 * 25.4)
    temperature = study.readings[0].temperature_c
    assert temperature is not None
    assert temperature.tolist() == [20.5, 20.5, 21.5, 21.5]
    fit = study.fit
    assert (fit.loss, fit.method, fit.budget, fit.judge_extras) == ("tukey", "evolution", 5000, False)
    assert fit.extras == ["encoder-harmonics", "link-expansion", "compliance"]
    assert (fit.harmonics, fit.box_length_mm) == ([1, 4], pytest.approx(50.8))
    assert (fit.box_angle_rad, fit.box_offset_rad) == pytest.approx((math.radians(10), math.radians(30)))
    assert assemble(study).names[-2:] == ["artefact.ball.diameter", "artefact.bar.length"]
    assert fit.prior["joint.1.a"].in_unit("mm") == pytest.approx((0.02 * 25.4, 1.5 * 25.4))
    assert fit.prior["joint.*.theta0"].in_unit("rad") == (pytest.approx(math.radians(1)), None)
    assert fit.prior["joint.*.expansion"].in_unit("1/K") == (2e-6, 1.1e-5)
