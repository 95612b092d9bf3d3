"""The commands through the installed program: what they print and write, exit codes, and nothing half written."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import BENT, STRAIGHT, assert_bad_input, platinum, run, strict_json, write_lengths

import ulna
from ulna.artefacts.quantities import NAMES


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """A study calibrated into `out`, by the command."""
    folder = tmp_path_factory.mktemp("lengths")
    study = write_lengths(folder, noise="[noise]\nencoder = 5e-6\nseat = 0.006")
    return folder, run("calibrate", study, "-o", folder / "out")


def test_calibrate_prints_and_writes(calibrated: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, done = calibrated
    assert done.returncode == 0, done.stderr
    assert max(len(line) for line in done.stdout.splitlines()) <= 80
    assert "25 of 27 free parameters" in " ".join(done.stdout.split())
    assert "joint.1.theta0" in done.stdout
    assert sorted(path.name for path in (folder / "out").iterdir()) == ["arm.toml", "residuals.csv", "result.json"]
    document = strict_json((folder / "out" / "result.json").read_text())
    assert document["format"] == "ulna-result/1"
    assert len(document["residuals"]) == document["fit"]["readings"] == 101
    assert set(document["residuals"][0]) == {
        *("row", "file", "artefact", "placement", "probe", "length_mm", "norm_mm", "weight"),
        *("times_scatter", "outlier"),
    }
    status = {row["name"]: row["status"] for row in document["parameters"]}
    assert [name for name, each in status.items() if each == "not-determined"] == ["joint.1.theta0", "joint.1.d"]
    assert all((row["u"] is None) == (row["status"] != "fitted") for row in document["parameters"])
    assert document["probes"]["bent"]["r_mm"] == pytest.approx(39.4321, abs=1.0)
    assert {entry["sha256"] for entry in document["provenance"]["files"]}
    assert document["provenance"]["noise"] == {"encoder_rad": [5e-6] * 7, "seat_mm": 0.006}


def test_a_result_loads_as_it_was_and_so_does_its_arm(
    calibrated: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    folder, _ = calibrated
    result = ulna.Result.load(folder / "out")
    direct = ulna.calibrate(ulna.Study.load(folder / "study.toml"))
    assert result.parameters == direct.parameters
    assert result.fit == direct.fit
    assert result.identifiability == direct.identifiability
    assert result.artefacts == direct.artefacts
    assert (result.before, result.after) == (direct.before, direct.after)
    assert result.residuals.equals(direct.residuals)
    np.testing.assert_array_equal(result.covariance.matrix, direct.covariance.matrix)
    as_toml = ulna.Arm.load(folder / "out" / "arm.toml")
    np.testing.assert_array_equal(as_toml.parameters, result.arm.parameters)


def test_json_is_the_file(calibrated: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, _ = calibrated
    done = run("calibrate", folder / "study.toml", "--json")
    printed, written = strict_json(done.stdout), strict_json((folder / "out" / "result.json").read_text())
    for document in (printed, written):
        del document["provenance"]["time"], document["provenance"]["duration_s"]
    assert printed == written


def test_an_earlier_result_is_kept_without_force(calibrated: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, _ = calibrated
    before = (folder / "out" / "result.json").read_bytes()
    assert_bad_input(run("calibrate", folder / "study.toml", "-o", folder / "out"), "--force")
    assert (folder / "out" / "result.json").read_bytes() == before
    assert run("calibrate", folder / "study.toml", "-o", folder / "out", "--force").returncode == 0


def test_no_convergence_is_exit_code_1_and_said(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, fit="max_iterations = 1")
    done = run("calibrate", study, "-o", tmp_path / "out")
    assert done.returncode == 1
    assert "did not converge" in done.stderr
    assert strict_json((tmp_path / "out" / "result.json").read_text())["fit"]["converged"] is False


def test_fewer_readings_than_unknowns(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, rows=12)
    assert_bad_input(run("calibrate", study, "-o", tmp_path / "out"), "study.toml")
    assert not (tmp_path / "out").exists()


def test_warnings_go_to_stderr(tmp_path: Path) -> None:
    study = write_lengths(tmp_path)
    lines = (tmp_path / "rows.csv").read_text().splitlines()
    (tmp_path / "rows.csv").write_text("\n".join([*lines, lines[5]]) + "\n")
    done = run("calibrate", study)
    assert done.returncode == 0
    (warning,) = [line for line in done.stderr.splitlines() if line.startswith("warning: ")]
    assert "102" in warning


def test_identify(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, probes={"straight": STRAIGHT})
    done = run("identify", study)
    assert done.returncode == 0, done.stderr
    assert max(len(line) for line in done.stdout.splitlines()) <= 80
    assert "23 of 27 free parameters" in " ".join(done.stdout.split())
    assert "Remedy:" in done.stdout
    document = strict_json(run("identify", study, "--json").stdout)
    assert (document["parameters"], document["determined"]) == (27, 23)
    assert all(direction["because"] and direction["remedy"] for direction in document["lost"])


def test_evaluate(calibrated: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path) -> None:
    folder, _ = calibrated
    start, after = (
        run("evaluate", folder / arm, folder / "study.toml", "-o", tmp_path / arm.replace("/", "-"))
        for arm in ("start.toml", "out/result.json")
    )
    assert start.returncode == after.returncode == 0
    assert "length error" in after.stdout
    found = [
        strict_json((tmp_path / name / "evaluation.json").read_text()) for name in ("start.toml", "out-result.json")
    ]
    assert all(document["format"] == "ulna-evaluation/1" for document in found)
    assert set(found[0]["overall"]) <= set(NAMES)
    assert found[1]["overall"]["length_error_rms_mm"] < 0.02 < found[0]["overall"]["length_error_rms_mm"]
    assert [(e["artefact"], e["placement"], e["readings"]) for e in found[1]["artefacts"]] == [
        ("rows", "right", 51),
        ("rows", "left", 50),
    ]


def test_evaluate_with_an_arm_that_lacks_the_probe(tmp_path: Path) -> None:
    study = write_lengths(tmp_path)
    platinum({"bend": BENT}).save(tmp_path / "other.toml")
    assert_bad_input(run("evaluate", tmp_path / "other.toml", study), "no probe 'bent'", "Did you mean 'bend'?")


def test_cross_validate(tmp_path: Path) -> None:
    study = write_lengths(tmp_path)
    done = run("cross-validate", study, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    document = strict_json((tmp_path / "out" / "cross-validation.json").read_text())
    assert [group["group"] for group in document["groups"]] == ["right", "left"]
    means = [group["after"]["length_error_mean_abs_mm"] for group in document["groups"]]
    assert document["after"]["length_error_mean_abs_mm"] == pytest.approx(np.mean(means))
    assert document["after"]["length_error_mean_abs_mm"] < 0.1 < document["before"]["length_error_mean_abs_mm"]
    assert strict_json(run("cross-validate", study, "--by", "4", "--json").stdout)["by"] == "4 folds of placements"
    assert_bad_input(run("cross-validate", study, "--by", "plate"), "'placement', 'artefact' or a number")


def test_what_is_left_out_was_not_fitted(tmp_path: Path) -> None:
    """Corrupting the readings left out must leave the arm fitted without them as it was."""
    study = ulna.Study.load(write_lengths(tmp_path))
    clean = ulna.cross_validate(study)
    lengths = study.readings[0].length_mm
    assert lengths is not None
    lengths[study.readings[0].placement == "left"] += 5.0
    spoilt = ulna.cross_validate(study)
    left = [next(group for group in found.groups if group.group == "left") for found in (clean, spoilt)]
    shift = left[1].after["length_error_mean_mm"] - left[0].after["length_error_mean_mm"]
    assert shift == pytest.approx(-5.0, abs=1e-6)


def test_an_arm_that_is_held_and_explains_nothing_is_not_good(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, noise="[noise]\nencoder = 5e-6", fit='hold = ["*"]')
    done = run("calibrate", study, "-o", tmp_path / "out")
    assert done.returncode == 1, done.stdout
    document = strict_json((tmp_path / "out" / "result.json").read_text())
    assert (document["fit"]["termination"], document["fit"]["converged"]) == ("held-poor", False)
    assert document["fit"]["chi2_per_dof"] > 1e4
    assert "every parameter is held" in done.stdout
    assert "times what the stated noise explains" in " ".join(done.stdout.split())
    page = run("report", tmp_path / "out", "-o", tmp_path / "out.html")
    assert page.returncode == 0
    assert "does NOT explain" in (tmp_path / "out.html").read_text()


def test_everything_held_is_an_evaluation(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, noise="[noise]\nencoder = 5e-6\nseat = 0.01", fit='hold = ["*"]')
    platinum().save(tmp_path / "start.toml", force=True)
    done = run("calibrate", study, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    document = strict_json((tmp_path / "out" / "result.json").read_text())
    assert document["fit"]["termination"] == "nothing-to-fit"
    assert {row["status"] for row in document["parameters"]} == {"held"}
    assert document["overall"]["before"] == document["overall"]["after"]
    points = run("measure", tmp_path / "out" / "result.json", tmp_path / "rows.csv")
    assert points.stdout.startswith("x,y,z,u_x,u_y,u_z\n")
    assert_bad_input(run("identify", study), "hold every parameter")
