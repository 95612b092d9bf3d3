"""Two commands and no edit: from the table of a home-built arm to the arm that it is."""

from __future__ import annotations

from pathlib import Path

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
    length_errors_mm,
    measured,
    text,
    turned,
    workbook,
)

from ulna import Arm
from ulna.exchange.export.dh import dh_table
from ulna.exchange.export.urdf import urdf_text

#: noise of 0.02 mm and 5e-5 rad leaves this much of a length anywhere
MOST_MM = 0.15
BAR = ("--artefact", "bar", "--length", str(LENGTH_MM))


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Kept:
    """What was measured; the same in all tests."""
    return measured(tmp_path_factory.mktemp("kept"))


def calibrated(folder: Path, readings: str, *options: str | Path) -> tuple[Arm, str, str]:
    """The arm that the two commands find, what the first printed and what the second did."""
    made = run("new", "--readings", folder / readings, *options, "-o", folder / "study")
    assert made.returncode == 0, made.stderr
    done = run("calibrate", folder / "study" / "study.toml", "-o", folder / "result")
    assert done.returncode == 0, done.stderr
    return Arm.load(folder / "result" / "arm.toml"), made.stdout, done.stdout


def assert_right(found: Arm, kept: Kept) -> None:
    """Lengths that the arm measures are those of the true arm."""
    good = np.delete(kept.q_rad, np.array(MISSED) - 1, axis=0)
    assert abs(length_errors_mm(found, kept.truth, good)).max() < MOST_MM


@pytest.mark.parametrize(("words", "merged"), [(GERMAN, True), (GERMAN, False), (CHINESE, True)])
def test_a_workbook_of_counts_and_a_reach(tmp_path: Path, kept: Kept, words: dict, merged: bool) -> None:
    """Titles, headings of another language, merged or blank cells, comments; nothing is known of zeros, signs or links.
    The five bad touches are named by their cells, and nothing else is."""
    workbook(kept, tmp_path / "book.xlsx", words, merged)
    options = (*BAR, "--reach", "1000", "--counts-per-turn", str(COUNTS))
    found, shown, report = calibrated(tmp_path, "book.xlsx", *options)
    assert_right(found, kept)
    assert words["comment"] in shown
    assert "not used" in shown
    assert report.count(f"{words['sheet']}!A") + report.count(f"'{words['sheet']}'!A") >= len(MISSED)
    assert "Far off the rest: 5 of 179 readings" in report
    for row in MISSED:
        assert f"row {row} (" in report
        assert f"!A{row + 4})" in report


@pytest.mark.parametrize(
    ("words", "encoding", "separator", "decimal", "unit"),
    [
        (GERMAN, "cp1252", ";", ",", " [°]"),
        (GERMAN, "utf-16", "\t", ",", ""),
        (CHINESE, "gbk", ",", ".", "(度)"),
        (CHINESE, "utf-8-sig", ";", ".", ""),
    ],
)
def test_a_text_of_degrees(
    tmp_path: Path, kept: Kept, words: dict, encoding: str, separator: str, decimal: str, unit: str
) -> None:
    text(kept, tmp_path / "out.csv", words, encoding, np.degrees(kept.q_rad), separator, decimal, unit)
    found, shown, report = calibrated(tmp_path, "out.csv", *BAR, "--reach", "1400")
    assert_right(found, kept)
    assert "deg" in shown
    assert "Far off the rest: 5 of 179 readings" in report


@pytest.mark.parametrize("known", ["known", "unknown"])
def test_a_table_of_denavit_hartenberg(tmp_path: Path, kept: Kept, known: str) -> None:
    """A drawing a little off, with and without its zeros and signs; angles in rad."""
    drawing = turned(kept.truth, 0.02, 2.0, seed=4)
    path = tmp_path / "dh.csv"
    path.write_text(dh_table(drawing, "dh", path, "mm", "deg"))
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", kept.q_rad, ",", ".")
    options = (*BAR, "--dh", path, "--convention", "dh", "--zeros", known, "--signs", known)
    found, shown, _ = calibrated(tmp_path, "out.csv", *options)
    assert_right(found, kept)
    assert "rad: they go from" in shown
    assert ("are not known" in shown) == (known == "unknown")


def test_a_urdf(tmp_path: Path, kept: Kept) -> None:
    """The columns are called as the joints of the drawing; angles in degrees."""
    drawing = turned(kept.truth, 0.02, 2.0, seed=5)
    (tmp_path / "arm.urdf").write_text(urdf_text(drawing))
    words = GERMAN | {"axis": "joint_{}"}
    text(kept, tmp_path / "out.csv", words, "utf-8", np.degrees(kept.q_rad), ",", ".")
    options = (*BAR, "--urdf", tmp_path / "arm.urdf", "--zeros", "known", "--signs", "known")
    found, _, _ = calibrated(tmp_path, "out.csv", *options)
    assert_right(found, kept)


def test_another_arm_another_seed(tmp_path: Path) -> None:
    """Nothing was made for the one arm above."""
    other = measured(tmp_path / "made", seed=8)
    workbook(other, tmp_path / "book.xlsx")
    found, _, _ = calibrated(tmp_path, "book.xlsx", *BAR, "--reach", "900", "--counts-per-turn", str(COUNTS))
    assert_right(found, other)
