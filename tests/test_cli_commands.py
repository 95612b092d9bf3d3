"""The commands through the installed program: what they print and write, exit codes, and nothing half written."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import ulna
from ulna.figures import NAMES
from ulna.model import Arm, Joint, Probe

TABLE_4 = [
    (1.521927, -1.572781, 42.4754, 149.7000),
    (0.791659, 1.567756, -42.0588, -0.9472),
    (0.022211, -1.570242, 28.5382, 439.5104),
    (0.879434, 1.568061, -28.5351, -0.8421),
    (0.032396, -1.574439, 28.5535, 439.4015),
    (0.860088, 1.572594, -28.5478, -0.9604),
]
BENT = Probe.from_cylindrical(0.431148, 39.4321, 223.8773)
STRAIGHT = Probe(0.0, 0.0, 238.5596)


def platinum(probes: dict[str, Probe] | None = None, wrong: float = 0.0) -> Arm:
    rng = np.random.default_rng(9)
    joints = [Joint(*(np.array(row) + wrong * rng.uniform(-1, 1, 4) * [0.02, 0.01, 5, 5])) for row in TABLE_4]
    return Arm("virtual Platinum", (*joints, Joint()), probes or {"bent": BENT})


def write_lengths(
    folder: Path, rows: int = 101, probes: dict[str, Probe] | None = None, noise: str = "", fit: str = ""
) -> Path:
    """A study of length rows in two placements, its start arm a little wrong."""
    rng = np.random.default_rng(2)
    truth = platinum(probes)
    q, p = rng.uniform(-2.5, 2.5, (2, rows, 7))
    probe = next(iter(truth.probes))
    length = np.linalg.norm(truth.tip(q, probe) - truth.tip(p, probe), axis=1) + rng.normal(0, 0.01, rows)
    columns: dict[str, Any] = {f"q{k + 1}": q[:, k] for k in range(7)} | {f"p{k + 1}": p[:, k] for k in range(7)}
    columns |= {"length": length, "placement": np.where(np.arange(rows) % 2, "left", "right")}
    folder.mkdir(parents=True, exist_ok=True)
    pl.DataFrame(columns).write_csv(folder / "rows.csv")
    platinum(probes, wrong=1.0).save(folder / "start.toml", force=True)
    study = folder / "study.toml"
    study.write_text(
        'format = "ulna-study/1"\narm = "start.toml"\nunits = { length = "mm", angle = "rad" }\n'
        f'[[readings]]\nfile = "rows.csv"\nartefact = "rows"\nprobe = "{probe}"\n[artefact.rows]\nkind = "length"\n'
        f"{noise}\n[fit]\n{fit}\n"
    )
    return study


def run(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "ulna", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb"} | environment,
        check=False,
    )


def assert_bad_input(done: subprocess.CompletedProcess[str], *expected: str) -> None:
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for each in expected:
        assert each in done.stderr


def strict_json(text: str) -> Any:
    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    return json.loads(text, parse_constant=refuse)


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
        *("row", "file", "artefact", "placement", "probe", "length_mm", "norm_mm", "weight")
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


def test_reproduce_lists_studies() -> None:
    done = run("reproduce")
    assert done.returncode == 0, done.stderr
    assert "cheng2011" in done.stdout
    assert "cheng2011" in strict_json(run("reproduce", "--json").stdout)["studies"]
    assert_bad_input(run("reproduce", "cheng2010"), "Did you mean 'cheng2011'?")


def test_unknown_command_and_option_name_the_nearest() -> None:
    assert_bad_input(run("calibrat", "x.toml"), "Did you mean 'calibrate'?")
    assert_bad_input(run("calibrate", "x.toml", "--froce"), "--force")


@pytest.mark.parametrize(
    "command", ["calibrate", "identify", "evaluate", "measure", "cross-validate", "reproduce", "import mukca"]
)
def test_each_help_has_an_example(command: str) -> None:
    done = run(*command.split(), "--help")
    assert done.returncode == 0, done.stderr
    assert f"ulna {command} " in done.stdout.split("Example", 1)[1]
    assert max(len(line) for line in done.stdout.splitlines()) <= 80


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys\nfrom ulna.cli import main\nsys.argv = ['ulna', '--help']\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "print([name for name in ('numpy', 'polars', 'pyarrow', 'pydantic', 'scipy', 'matplotlib', 'ulna._core') "
        "if name in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stderr.strip() == "[]"


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX pipes")
def test_a_reader_who_has_seen_enough_is_no_error(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    q = np.random.default_rng(0).uniform(-3, 3, (200_000, 7))
    pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(7)}).write_parquet(tmp_path / "q.parquet")
    command = f"{sys.executable} -m ulna measure {tmp_path}/arm.toml {tmp_path}/q.parquet | head -2"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60, check=True)
    assert done.stderr == ""
    assert done.stdout.startswith("x,y,z\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_disk_is_told(tmp_path: Path) -> None:
    study = write_lengths(tmp_path)
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "ulna", "calibrate", str(study)],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
            check=False,
        )
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "No space left" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_ctrl_c_leaves_nothing(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, rows=3000, fit='start = "search"')
    # zero offsets so wrong, and lengths so noisy, that the search has work for long
    rows = pl.read_csv(tmp_path / "rows.csv")
    noise = pl.Series(np.random.default_rng(5).normal(0, 200, rows.height))
    rows.with_columns((pl.col("length") + noise).abs()).write_csv(tmp_path / "rows.csv")
    process = subprocess.Popen(
        [sys.executable, "-m", "ulna", "cross-validate", str(study), "--by", "1000", "-o", str(tmp_path / "out")],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    time.sleep(1.5)
    assert process.poll() is None, "the work was over before it could be interrupted"
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert out == ""
    assert "Interrupted" in err
    assert "Traceback" not in err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rows.csv", "start.toml", "study.toml"]
