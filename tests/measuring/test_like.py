"""`ulna measure --like STUDY`: nothing that the study says of its readings is typed again."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import BENT, STRAIGHT, assert_bad_input, platinum, run

from ulna.ground.errors import UlnaInputError
from ulna.measuring.like import like_study

Q = np.random.default_rng(8).uniform(-3, 3, (12, 7)).round(6)
COUNTS = 65536.0

STUDY = """\
format = "ulna-study/1"
arm = "arm.toml"
units = { length = "mm", angle = "rad" }

[[readings]]
file = "bars.csv"
angle = "counts"
separator = ";"
decimal = ","
probe = "bent"
columns = { q1 = "Achse 1", q2 = "Achse 2", q3 = "Achse 3", q4 = "Achse 4", q5 = "Achse 5", q6 = "Achse 6", \
q7 = "Achse 7", feature = "Ende", placement = "Messung" }
names = { feature = { A = "links", B = "rechts" } }
where = { Status = "ok" }

[artefact.bar]
kind = "bar"
length = 443.172
"""


def counting() -> Any:
    arm = platinum({"bent": BENT, "straight": STRAIGHT})
    joints = tuple(dataclasses.replace(joint, counts_per_turn=COUNTS) for joint in arm.joints)
    return dataclasses.replace(arm, joints=joints)


def kept(folder: Path, study: str = STUDY) -> Path:
    """An arm, a study and readings as the study's owner keeps them."""
    counting().save(folder / "arm.toml", force=True)
    (folder / "study.toml").write_text(study)
    table = pl.DataFrame({f"Achse {k + 1}": Q[:, k] / (2 * np.pi) * COUNTS for k in range(7)})
    table = table.with_columns(pl.lit("ok").alias("Status"), pl.lit("links").alias("Ende"))
    table.write_csv(folder / "r.csv", separator=";", decimal_comma=True)
    return folder / "r.csv"


def test_readings_like_those_of_the_study(tmp_path: Path) -> None:
    done = run("measure", tmp_path / "arm.toml", kept(tmp_path), "--like", tmp_path / "study.toml")
    assert done.returncode == 0, done.stderr
    points = pl.read_csv(done.stdout.encode())
    np.testing.assert_allclose(points.to_numpy(), platinum().tip(Q), rtol=0, atol=1e-9)
    assert "'readings.1.where' is not used: every row is measured" in done.stderr
    assert "Achse" not in done.stderr, "columns that the study speaks of are no surprise"


def test_from_stdin_too(tmp_path: Path) -> None:
    import subprocess
    import sys

    readings = kept(tmp_path)
    command = [sys.executable, "-m", "ulna", "measure", tmp_path / "arm.toml", "-", "--like", tmp_path / "study.toml"]
    done = subprocess.run(command, input=readings.read_bytes(), capture_output=True, check=True)
    of_file = run("measure", tmp_path / "arm.toml", readings, "--like", tmp_path / "study.toml")
    assert done.stdout.decode() == of_file.stdout


def test_what_is_said_on_the_command_line_goes_first(tmp_path: Path) -> None:
    readings = kept(tmp_path)
    readings.write_text(readings.read_text().replace(";", "|"))
    common = ["measure", tmp_path / "arm.toml", readings, "--like", tmp_path / "study.toml"]
    done = run(*common, "--separator", "|", "--probe", "straight")
    assert done.returncode == 0, done.stderr
    straight = platinum({"straight": STRAIGHT}).tip(Q)
    np.testing.assert_allclose(pl.read_csv(done.stdout.encode()).to_numpy(), straight, rtol=0, atol=1e-9)
    # without it the study's own key is what the message names
    assert_bad_input(run(*common), "study.toml: key 'readings.1.separator'")


def test_several_readings_are_alike_or_asked_about(tmp_path: Path) -> None:
    kept(tmp_path)
    entry = STUDY[STUDY.index("[[readings]]") : STUDY.index("[artefact")]
    alike = STUDY.replace("[artefact", entry.replace("bars.csv", "more.csv") + "[artefact")
    (tmp_path / "study.toml").write_text(alike)
    assert like_study(tmp_path / "study.toml").angle == "counts"
    other = STUDY.replace("[artefact", entry.replace('"counts"', '"deg"') + "[artefact")
    (tmp_path / "study.toml").write_text(other)
    with pytest.raises(UlnaInputError, match=r"written differently .*--like-readings N"):
        like_study(tmp_path / "study.toml")
    assert like_study(tmp_path / "study.toml", 2).angle == "deg"
    with pytest.raises(UlnaInputError, match=r"got 3, but .* has 2 \[\[readings\]\]"):
        like_study(tmp_path / "study.toml", 3)
    done = run("measure", tmp_path / "arm.toml", tmp_path / "r.csv", "--like-readings", "1")
    assert_bad_input(done, "--like-readings: got 1 without --like")


def test_the_study_is_never_overwritten(tmp_path: Path) -> None:
    readings = kept(tmp_path)
    text = (tmp_path / "study.toml").read_text()
    (tmp_path / "points.csv").symlink_to(tmp_path / "study.toml")
    done = run(
        "measure",
        tmp_path / "arm.toml",
        readings,
        "--like",
        tmp_path / "study.toml",
        "-o",
        tmp_path / "points.csv",
        "--force",
    )
    assert_bad_input(done, "is an input of this run")
    assert (tmp_path / "study.toml").read_text() == text
