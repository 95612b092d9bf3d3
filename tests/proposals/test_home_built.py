"""Two commands and no edit: from the table of a home-built arm to the arm that it is."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.cli_runs import run
from tests.home_built import (
    CHINESE,
    COUNTS,
    GERMAN,
    LENGTH_MM,
    MISSED,
    Kept,
    example,
    length_errors_mm,
    measured,
    text,
    turned,
    workbook,
)

from ulna import Arm, Joint, Probe, Study
from ulna.calibration.calibrate import calibrate
from ulna.calibration.result import Result
from ulna.exchange.export.dh import dh_table
from ulna.exchange.export.urdf import urdf_text
from ulna.proposals.answers import Answers
from ulna.proposals.propose import Proposal, propose
from ulna.proposals.write import write_proposal

#: noise of 0.02 mm and 5e-5 rad leaves this much of a length anywhere
MOST_MM = 0.15
BAR = ("--artefact", "bar", "--length", str(LENGTH_MM))


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Kept:
    """What was measured; the same in all tests."""
    return measured(tmp_path_factory.mktemp("kept"))


def commands(folder: Path, readings: str, *options: str | Path) -> tuple[Arm, str, str]:
    """The arm that the two commands find, what the first printed and what the second did."""
    made = run("new", "--readings", folder / readings, *options, "-o", folder / "study")
    assert made.returncode == 0, made.stderr
    done = run("calibrate", folder / "study" / "study.toml", "-o", folder / "result")
    assert done.returncode == 0, done.stderr
    return Arm.load(folder / "result" / "arm.toml"), made.stdout, done.stdout


def found(folder: Path, readings: str, **said: Any) -> tuple[Result, Proposal]:
    """The same without the commands."""
    proposal = propose(Answers(readings=folder / readings, artefact="bar", length=LENGTH_MM, **said))
    write_proposal(proposal, folder / "study")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        result = calibrate(Study.load(folder / "study" / "study.toml"))
    assert result.fit.converged
    return result, proposal


def assert_right(found: Arm, kept: Kept) -> None:
    """Lengths that the arm measures are those of the true arm."""
    good = np.delete(kept.q_rad, np.array(MISSED) - 1, axis=0)
    assert abs(length_errors_mm(found, kept.truth, good)).max() < MOST_MM


def test_the_example_is_what_its_generator_makes(tmp_path: Path, root: Path) -> None:
    example(tmp_path / "messung.csv", tmp_path / "made")
    assert (root / "examples" / "home-built" / "messung.csv").read_bytes() == (tmp_path / "messung.csv").read_bytes()


def test_two_commands_and_a_workbook(tmp_path: Path, kept: Kept) -> None:
    """German titles and headings, merged cells, comments, counts; nothing is known of zeros, signs or links. The five
    bad touches are named by their cells, and nothing else is."""
    workbook(kept, tmp_path / "book.xlsx")
    arm, shown, report = commands(
        tmp_path, "book.xlsx", *BAR, "--reach", "1000", "--parallel", "none", "--counts-per-turn", str(COUNTS)
    )
    assert_right(arm, kept)
    assert re.search(r"Bemerkung +not used", shown)
    assert re.search(r"Ende +feature .*'links' is A, 'rechts' is B", shown)
    assert "Far off the rest: 5 of 179 readings" in report
    for row in MISSED:
        assert f"row {row} (Messwerte!A{row + 4})" in report


@pytest.mark.parametrize("seed", [3, 8])
def test_chinese_headings_blank_cells_and_other_arms(tmp_path: Path, seed: int) -> None:
    """Where cells are blank and not merged, what stands above counts."""
    other = measured(tmp_path / "made", seed=seed)
    workbook(other, tmp_path / "book.xlsx", CHINESE, merged=False)
    result, proposal = found(tmp_path, "book.xlsx", reach=900.0, parallel=("none",), counts_per_turn=(float(COUNTS),))
    assert_right(result.arm, other)
    assert proposal.entry["fill_down"] == ["placement"]
    assert {row["place"] for row in result.outliers} >= {f"'数据'!A{row + 4}" for row in MISSED}


@pytest.mark.parametrize(
    ("words", "encoding", "separator", "decimal", "unit"),
    [
        (GERMAN, "cp1252", ";", ",", " [°]"),
        (GERMAN, "utf-16", "\t", ",", ""),
        (CHINESE, "gbk", ",", ".", "(度)"),
    ],
)
def test_a_text_of_degrees(
    tmp_path: Path, kept: Kept, words: dict[str, Any], encoding: str, separator: str, decimal: str, unit: str
) -> None:
    text(kept, tmp_path / "out.csv", words, encoding, np.degrees(kept.q_rad), separator, decimal, unit)
    result, proposal = found(tmp_path, "out.csv", reach=1400.0, parallel=("none",))
    assert_right(result.arm, kept)
    assert proposal.angle == "deg"
    assert {row["row"] for row in result.outliers} >= set(MISSED)


@pytest.mark.parametrize("known", ["known", "unknown"])
def test_a_table_of_denavit_hartenberg(tmp_path: Path, kept: Kept, known: str) -> None:
    """A drawing a little off, with and without its zeros and signs; angles in rad."""
    drawing = turned(kept.truth, 0.02, 2.0, seed=4)
    path = tmp_path / "dh.csv"
    path.write_text(dh_table(drawing, "dh", path, "mm", "deg"))
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", kept.q_rad, ",", ".")
    result, proposal = found(tmp_path, "out.csv", dh=path, convention="dh", zeros=known, signs=known)
    assert_right(result.arm, kept)
    assert proposal.angle == "rad"
    assert proposal.search == (known == "unknown")


def test_a_urdf(tmp_path: Path, kept: Kept) -> None:
    """The columns are called as the joints of the drawing; angles in degrees."""
    drawing = turned(kept.truth, 0.02, 2.0, seed=5)
    (tmp_path / "arm.urdf").write_text(urdf_text(drawing))
    words = GERMAN | {"axis": "joint_{}"}
    text(kept, tmp_path / "out.csv", words, "utf-8", np.degrees(kept.q_rad), ",", ".")
    result, proposal = found(tmp_path, "out.csv", urdf=tmp_path / "arm.urdf", zeros="known", signs="known")
    assert_right(result.arm, kept)
    assert proposal.taken[1].why == "the joint's name in the drawing"


def test_an_arm_whose_axes_are_parallel(tmp_path: Path) -> None:
    """Built as robots are: shoulder and elbow turn about parallel axes. Said so, the arm is found; not said, no wrong
    arm is called good."""
    right = np.pi / 2
    joints = [
        Joint(0.3, right + 0.003, 20.0, 300.0),
        Joint(-1.0, 0.02, 400.0, 0.0, sign=-1),
        Joint(0.5, right, 10.0, 5.0),
        Joint(2.0, -right, 0.0, 380.0),
        Joint(1.0, right, 0.0, 3.0, sign=-1),
    ]
    robot = Arm("robot", (*joints, Joint()), {"tip": Probe(30.0, 10.0, 150.0)})
    other = measured(tmp_path / "made", 3, robot)
    workbook(other, tmp_path / "book.xlsx")
    said = {"reach": 1100.0, "counts_per_turn": (float(COUNTS),)}
    result, _ = found(tmp_path, "book.xlsx", parallel=("2",), **said)
    assert_right(result.arm, other)
    workbook(other, tmp_path / "made" / "book.xlsx")
    with pytest.raises(AssertionError, match="converged"):
        found(tmp_path / "made", "book.xlsx", parallel=("none",), **said)
