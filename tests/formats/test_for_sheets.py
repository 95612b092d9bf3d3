"""No text of a table for people is a formula in a spreadsheet."""

from __future__ import annotations

import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cli_runs import run, write_lengths

from ulna.formats.for_sheets import for_sheets

NASTY = ['=HYPERLINK("http://x","y")', "+1+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", " =1", "\r=1", "＝1+1"]


@pytest.mark.parametrize("text", NASTY)
def test_a_formula_is_a_text(text: str) -> None:
    assert for_sheets(pl.DataFrame({"name": [text, "A"]}))["name"].to_list() == ["'" + text, "A"]
    assert for_sheets(pl.DataFrame({text: [1.0]})).columns == ["'" + text]


@given(st.floats(allow_nan=False))
def test_numbers_stay(value: float) -> None:
    frame = pl.DataFrame({"x": [value], "name": [f"{value:g}" if abs(value) < 1e308 else "0"]})
    assert for_sheets(frame).equals(frame)


@given(st.lists(st.text(), min_size=1))
def test_all_that_is_changed_is_an_apostrophe(texts: list[str]) -> None:
    frame = pl.DataFrame({"name": texts})
    for before, after in zip(texts, for_sheets(frame)["name"].to_list(), strict=True):
        assert after in (before, "'" + before)
        assert after.strip("\x00 \t\r\n")[:1] not in ("=", "@")


def test_residuals_of_a_placement_with_such_a_name(tmp_path) -> None:
    study = write_lengths(tmp_path / "study")
    table = study.parent / "rows.csv"
    table.write_text(table.read_text().replace("left", '"=HYPERLINK(""http://x"")"'))
    done = run("calibrate", study, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    names = pl.read_csv(tmp_path / "out" / "residuals.csv")["placement"].unique().sort().to_list()
    assert names == ['\'=HYPERLINK("http://x")', "right"]
