"""What points are written to: the same numbers in every format, and a refusal in words of all others."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import openpyxl
import polars as pl
import pytest
import scipy.io
from tests.cli_runs import assert_bad_input, platinum, run

import ulna
from ulna.formats.layout import AS_EXPECTED
from ulna.formats.table import read_header, read_table
from ulna.formats.tables.coming import coming_table
from ulna.ground.errors import UlnaInputError
from ulna.measuring import written
from ulna.measuring.job import MeasureJob
from ulna.measuring.measure import measure_to_file

Q = np.random.default_rng(3).uniform(-3, 3, (9, 7)).round(6)


def sheet_of(path: Path) -> pl.DataFrame:
    """The sheet `points` as a spreadsheet's own library reads it."""
    names, *rows = openpyxl.load_workbook(path)["points"].iter_rows(values_only=True)
    return pl.DataFrame(rows, schema=[str(name) for name in names], orient="row")


READERS: dict[str, Callable[[Path], pl.DataFrame]] = {
    ".csv": pl.read_csv,
    ".txt": pl.read_csv,
    ".dat": pl.read_csv,
    ".tsv": lambda path: pl.read_csv(path, separator="\t"),
    ".parquet": pl.read_parquet,
    ".xlsx": lambda path: sheet_of(path),
    ".jsonl": pl.read_ndjson,
}


def readings(folder: Path) -> Path:
    columns = {f"q{k + 1}": Q[:, k] for k in range(7)}
    pl.DataFrame({"id": [f"=n{k}" for k in range(9)], **columns}).write_csv(folder / "r.csv")
    return folder / "r.csv"


@pytest.mark.parametrize("ending", written.ENDINGS)
def test_every_ending_holds_the_same_points(tmp_path: Path, ending: str) -> None:
    done = ulna.measure(platinum(), readings(tmp_path), out=tmp_path / f"points{ending}")
    table = READERS[ending](tmp_path / f"points{ending}")
    assert table.columns == done.columns == ["id", "x", "y", "z"]
    rtol = 3e-16 if ending == ".xlsx" else 0.0  # a workbook is written with 16 digits
    np.testing.assert_allclose(table.select("x", "y", "z").to_numpy(), platinum().tip(Q), rtol=rtol, atol=0)
    # in a text, which spreadsheets open too, it would be a formula
    text = "'" if ending in (".csv", ".txt", ".dat", ".tsv") else ""
    assert table["id"].to_list() == [f"{text}=n{k}" for k in range(9)]


def test_a_workbook_is_one_and_is_read_again(tmp_path: Path) -> None:
    ulna.measure(platinum(), readings(tmp_path), out=tmp_path / "points.XLSX")
    book = openpyxl.load_workbook(tmp_path / "points.XLSX")
    sheet = book["points"]
    assert [cell.value for cell in sheet[1]] == ["id", "x", "y", "z"]
    assert [cell.data_type for cell in sheet[2]] == ["s", "n", "n", "n"], "a name that begins with = is no formula"
    header = read_header(tmp_path / "points.XLSX")
    again = read_table(header, lambda column: column != "id")
    np.testing.assert_allclose(again.select("x", "y", "z").to_numpy(), platinum().tip(Q), rtol=3e-16, atol=0)


def test_an_uncertainty_that_is_not_known_is_an_empty_cell(tmp_path: Path) -> None:
    frame = pl.DataFrame({"x": [1.0, 2.0], "u_x": [0.5, None]})
    written.write_workbook(iter([frame]), tmp_path / "p.xlsx")
    rows = list(openpyxl.load_workbook(tmp_path / "p.xlsx")["points"].iter_rows(values_only=True))
    assert rows == [("x", "u_x"), (1, 0.5), (2, None)]


def test_more_points_than_a_sheet_holds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(written, "MOST_SHEET_ROWS", 9)
    with pytest.raises(UlnaInputError, match=r"points\.xlsx: a sheet of a workbook holds 8 points.*\.parquet or \.csv"):
        ulna.measure(platinum(), readings(tmp_path), out=tmp_path / "points.xlsx")
    assert not (tmp_path / "points.xlsx").exists()


def as_table(folder: Path, form: str, rows: int) -> Path:
    """Readings of one pose, over and over."""
    path, q_rad = folder / f"readings.{form}", np.tile(np.linspace(0.1, 0.7, 7), (rows, 1))
    frame = pl.DataFrame({f"q{k + 1}": q_rad[:, k] for k in range(7)})
    if form == "parquet":
        frame.write_parquet(path)
    elif form == "mat":
        scipy.io.savemat(path, {"q": q_rad})
    elif form == "xlsx":
        written.write_workbook(iter([frame]), path)
    else:
        path.write_text(frame.write_csv() + "\n\n")  # blank lines at the end are no rows
    return path


@pytest.mark.parametrize("form", ["csv", "parquet", "mat", "xlsx"])
def test_too_many_points_are_refused_before_the_first_is_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, form: str
) -> None:
    """With their number; as many as a sheet holds are written."""
    just, more = tmp_path / "just", tmp_path / "more"
    for folder, rows in ((just, 8), (more, 9)):
        folder.mkdir()
        as_table(folder, form, rows)
    monkeypatch.setattr(written, "MOST_SHEET_ROWS", 9)
    assert ulna.measure(platinum(), just / f"readings.{form}", out=tmp_path / "points.xlsx").rows == 8
    monkeypatch.setattr("ulna.measuring.job.MeasureJob.frames", lambda *_: pytest.fail("it was measured"))
    with pytest.raises(UlnaInputError, match="holds 8 points, and there are 9; expected another format"):
        ulna.measure(platinum(), more / f"readings.{form}", out=more / "points.xlsx")
    assert sorted(each.name for each in more.iterdir()) == [f"readings.{form}"]


def test_too_many_points_of_a_pipe_leave_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(written, "MOST_SHEET_ROWS", 9)
    text = as_table(tmp_path, "csv", 9).read_bytes()
    job = MeasureJob(platinum(), coming_table(io.BytesIO(text), "readings", AS_EXPECTED), None, "rad", "mm")
    with pytest.raises(UlnaInputError, match="holds 8 points, and there are more"):
        measure_to_file(job, tmp_path / "points.xlsx", [])
    assert sorted(each.name for each in tmp_path.iterdir()) == ["readings.csv"]


@pytest.mark.parametrize("name", ["points.mat", "points.h5", "points", "points.xls"])
def test_what_cannot_be_written_is_told_before_the_work(tmp_path: Path, name: str) -> None:
    platinum().save(tmp_path / "arm.toml")
    done = run("measure", tmp_path / "arm.toml", readings(tmp_path), "-o", tmp_path / name)
    assert_bad_input(done, name, "expected one of .csv", ".xlsx", "Name such a file")
    assert not (tmp_path / name).exists()


def test_a_folder_with_a_result_stands_for_its_arm_and_is_kept(tmp_path: Path) -> None:
    arm = platinum()
    (tmp_path / "out").mkdir()
    arm.save(tmp_path / "arm.toml")
    with pytest.raises(UlnaInputError, match="this is a folder"):
        ulna.measure(tmp_path / "out", readings(tmp_path))
    document = {"format": "ulna-result/1", "arm": {}}
    (tmp_path / "out" / "result.json").write_text(json.dumps(document))
    with pytest.raises(UlnaInputError, match=r"result\.json: key 'name'|result\.json"):
        ulna.measure(tmp_path / "out", readings(tmp_path))
