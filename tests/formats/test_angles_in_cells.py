"""Angles as people write them in cells: a degree sign, minutes and seconds; and columns between blanks. None is read in
silence as something else; the message has the number to write."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cli_runs import assert_bad_input, platinum, run

from ulna.formats.spelling import sexagesimal


def measured(folder: Path, cell: str) -> object:
    platinum().save(folder / "arm.toml", force=True)
    rows = ["q1,q2,q3,q4,q5,q6,q7", ",".join([cell] * 7)]
    (folder / "t.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return run("measure", folder / "arm.toml", folder / "t.csv", "--angle", "deg")


@pytest.mark.parametrize("cell", ["12.5°", "-12.5 °"])
def test_a_degree_sign_is_told_with_the_number(tmp_path: Path, cell: str) -> None:
    assert_bad_input(measured(tmp_path, cell), "column 'q1'", f"expected '{cell.rstrip('° ')}'", "remove the sign")


@pytest.mark.parametrize("cell", ["12°30'15\"", "12° 30' 15''", "12°30′15″", "12°30'15"])
def test_minutes_and_seconds_are_told_in_decimal_degrees(tmp_path: Path, cell: str) -> None:
    expected = "12.500000" if cell.endswith("15") else "12.504167"
    done = measured(tmp_path, cell)
    assert_bad_input(done, "degrees, minutes and seconds", f"such as {expected}", "deg")
    assert "quotation mark" not in done.stderr  # type: ignore[attr-defined]


@given(st.booleans(), st.integers(0, 359), st.integers(0, 59), st.integers(0, 59))
def test_what_is_shown_is_the_angle(negative: bool, degrees: int, minutes: int, seconds: int) -> None:
    """In seconds of arc, counted without fractions."""
    text = f"{'-' * negative}{degrees}°{minutes:02}'{seconds:02}\""
    found = sexagesimal(text)
    assert found is not None
    assert round(found * 3600) == (-1 if negative else 1) * (degrees * 3600 + minutes * 60 + seconds)
    assert sexagesimal(re.sub("°.*", "", text)) is None


def test_columns_between_blanks_are_asked_about_and_read_when_said(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    names = " ".join(f"q{k}" for k in range(1, 8))
    (tmp_path / "t.txt").write_text(f"{names}\n0.1 0.2 0.3 0.4 0.5 0.6 0.7\n")
    done = run("measure", tmp_path / "arm.toml", tmp_path / "t.txt")
    assert_bad_input(done, "one column, 'q1 q2", "separated by blanks?", '--separator " "')
    assert run("measure", tmp_path / "arm.toml", tmp_path / "t.txt", "--separator", " ").returncode == 0
