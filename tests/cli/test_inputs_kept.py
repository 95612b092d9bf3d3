"""No command overwrites what it reads, not even with --force; and Ctrl-C is answered before the program is there."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, platinum, run, write_lengths

import ulna
from ulna.ground.errors import UlnaInputError


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("target", ["other-arm.csv", "q.csv", "other-name.csv"])
def test_measure_keeps_the_arm_and_the_readings(tmp_path: Path, target: str) -> None:
    platinum().save(tmp_path / "arm.toml")
    (tmp_path / "q.csv").write_text("q1,q2,q3,q4,q5,q6,q7\n0,0,0,0,0,0,0\n")
    (tmp_path / "other-name.csv").symlink_to(tmp_path / "q.csv")
    (tmp_path / "other-arm.csv").symlink_to(tmp_path / "arm.toml")
    before = contents(tmp_path)
    out = tmp_path / target
    done = run("measure", tmp_path / "arm.toml", tmp_path / "q.csv", "-o", out, "--force")
    assert_bad_input(done, f"error: {out}: is an input of this run", "Name another place")
    with pytest.raises(UlnaInputError, match="is an input"):
        ulna.measure(tmp_path / "arm.toml", tmp_path / "q.csv", out=out, force=True)
    refused = run("measure", tmp_path / "arm.toml", tmp_path / "q.csv", "-o", tmp_path / "arm.toml", "--force")
    assert_bad_input(refused, "arm.toml: got the ending '.toml', which points cannot be written to")
    assert contents(tmp_path) == before


def study_with(folder: Path, old: str, new: str) -> Path:
    """A study of lengths that names `new` where it named `old`."""
    study = write_lengths(folder)
    (folder / old).rename(folder / new)
    study.write_text(study.read_text().replace(old, new))
    return study


def test_calibrate_keeps_the_start_arm(tmp_path: Path) -> None:
    study = study_with(tmp_path, "start.toml", "arm.toml")
    before = contents(tmp_path)
    done = run("calibrate", study, "-o", tmp_path, "--force")
    assert_bad_input(done, f"error: {tmp_path / 'arm.toml'}: is an input of this run")
    assert contents(tmp_path) == before


def test_evaluate_keeps_the_readings_and_the_arm(tmp_path: Path) -> None:
    study = study_with(tmp_path, "rows.csv", "residuals.csv")
    before = contents(tmp_path)
    done = run("evaluate", tmp_path / "start.toml", study, "-o", tmp_path, "--force")
    assert_bad_input(done, f"error: {tmp_path / 'residuals.csv'}: is an input of this run")
    assert contents(tmp_path) == before


def test_cross_validate_keeps_the_study(tmp_path: Path) -> None:
    study = tmp_path / "cross-validation.json"
    shutil.move(write_lengths(tmp_path), study)
    before = contents(tmp_path)
    done = run("cross-validate", study, "-o", tmp_path, "--force")
    assert_bad_input(done, f"error: {study}: is an input of this run")
    assert contents(tmp_path) == before


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize("command", [["-m", "ulna"], ["-c", "from ulna.__main__ import main; main()"]])
def test_ctrl_c_while_the_program_is_still_being_imported(tmp_path: Path, command: list[str]) -> None:
    (tmp_path / "typer.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n")
    done = subprocess.run(
        [sys.executable, *command],
        env={"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert done.returncode == 130
    assert done.stderr == "\nInterrupted. Nothing was written.\n"


def test_the_console_script_is_the_one_that_answers() -> None:
    pyproject = (Path(__file__).parents[2] / "pyproject.toml").read_text()
    assert '\nulna = "ulna.__main__:main"\n' in pyproject
