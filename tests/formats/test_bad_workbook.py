"""What is said to workbooks: the cell by its address, and what stands in it that is no number."""

from __future__ import annotations

import datetime
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl
import polars as pl
import pytest
from tests.foreign_tables import second_sheet, sheet
from tests.small_study import BARS, STUDY, SmallStudy, says

from ulna.formats.tables.workbook_cell import address, far_cell, stored_cell

TABLE = pl.read_csv(BARS.encode())
Edit = Callable[[Any], object]


def told(folder: Path, file: str, keys: str = "") -> str:
    small = SmallStudy(folder)
    small.write("study.toml", STUDY.replace('file = "bars.csv"\n', f'file = "{file}"\n{keys}\n'))
    return small.error()


def put(**cells: Any) -> Edit:
    def edit(page: Any) -> None:
        for at, value in cells.items():
            page[at] = value

    return edit


def at_b4(what: str) -> tuple[str, ...]:
    return ("row 3 (Sheet1!B4), column 'q2': got " + what, "expected a number")


#: how the sheet is spoilt, and what the message says
CASES: dict[str, tuple[Edit, tuple[str, ...]]] = {
    "text": (put(B4="n/a"), at_b4("'n/a'")),
    "a number as a text": (put(B4="1.25"), (*at_b4("'1.25' as a text"), "Turn the texts of this column into numbers")),
    "a decimal comma": (put(B4="1,25"), at_b4("'1,25' as a text")),
    "truth": (put(B4=True), at_b4("'true'")),
    "a date": (put(B4=datetime.date(2024, 5, 1)), (*at_b4("the date or time '2024-05-01'"), "taken for a date")),
    "a time": (put(B4=datetime.time(1, 5)), at_b4("the date or time '01:05:00'")),
    "a duration": (put(B4=datetime.timedelta(hours=30)), at_b4("the date or time")),
    "an error": (put(B4="#DIV/0!"), (*at_b4("the error #DIV/0!"), "Correct what it comes from")),
    "a formula": (put(B4="=A4*2"), (*at_b4("the formula '=A4*2', whose result is not in the file"), "and save it")),
    "a formula for a name": (put(E4='=UPPER("a")'), ("row 3 (Sheet1!E4)", "'feature'", "the formula", "a name")),
    "a gap": (put(B4=None), ("row 3 (Sheet1!B4), column 'q2': the cell is empty; expected a number",)),
    "a gap for a name": (put(E4=None), ("row 3 (Sheet1!E4), column 'feature': the cell is empty; expected a name",)),
    "merged": (
        lambda page: page.merge_cells("A3:B4"),
        ("row 2 (Sheet1!B3)", "one of the merged cells A3:B4", "only the first has a value", "Unmerge them"),
    ),
    "unknown feature": (put(E4="C"), ("row 3 (Sheet1!E4), column 'feature': got 'C'", "artefact 'bar'", "Known: A, B")),
    "degrees": (put(B4=95.5), ("row 3 (Sheet1!B4), column 'q2': got 95.5 rad", "±4π rad")),
    "no name": (put(C1=None), ("Sheet1!C2: got '1.102743' in a column without a name", "a name in the header")),
    "a name twice": (put(B1="q1"), ("column 'q1' appears twice",)),
    "numbers for names": (put(A1=1, B1=2, C1=3, D1=4, E1=5), ("row 1 of sheet 'Sheet1' holds numbers (1, 2, 3, …)",)),
    "nothing": (lambda page: page.delete_rows(1, 20), ("sheet 'Sheet1' is empty", "Name another sheet")),
    "only a header": (lambda page: page.delete_rows(2, 20), ("there are no rows", "'readings.1'")),
}


@pytest.mark.parametrize("case", CASES)
def test_what_a_sheet_is_told(tmp_path: Path, case: str) -> None:
    edit, fragments = CASES[case]
    sheet(TABLE, tmp_path / "b.xlsx", edit=edit)
    says(told(tmp_path, "b.xlsx"), str(tmp_path / "b.xlsx"), *fragments)


def test_a_sheet_of_another_name_is_quoted_as_excel_does(tmp_path: Path) -> None:
    sheet(TABLE, tmp_path / "b.xlsx", name="It's run 2", edit=put(A3="x"))
    says(told(tmp_path, "b.xlsx"), "row 2 ('It''s run 2'!A3), column 'q1': got 'x'")
    assert [address("", 0, k) for k in (0, 25, 26, 51, 52, 701, 702)] == [
        "A1",
        "Z1",
        "AA1",
        "AZ1",
        "BA1",
        "ZZ1",
        "AAA1",
    ]
    assert openpyxl.utils.get_column_letter(16384) == address("", 0, 16383)[:-1]


def test_which_sheet(tmp_path: Path) -> None:
    second_sheet(TABLE, tmp_path / "b.xlsx")
    says(told(tmp_path, "b.xlsx"), "b.xlsx: there are 2 sheets (Sheet, run 1)", 'Say sheet = "Sheet" in [[readings]]')
    says(told(tmp_path, "b.xlsx", 'sheet = "run1"'), "'readings.1.sheet': got 'run1'", "Did you mean 'run 1'?")
    says(told(tmp_path, "b.xlsx", 'sheet = "Sheet"'), "'q1' is missing", "none such (about this file)")


def test_a_sheet_without_a_header(tmp_path: Path) -> None:
    columns = 'header = false\ncolumns = { q1 = "c1", q2 = "c2", q3 = "c3", placement = "c4", feature = "c5" }'
    sheet(TABLE, tmp_path / "b.xlsx", edit=lambda page: page.delete_rows(1))
    small = SmallStudy(tmp_path)
    small.write("study.toml", STUDY.replace('file = "bars.csv"\n', f'file = "b.xlsx"\n{columns}\n'))
    study, warned = small.load()
    assert warned == []
    assert study.readings[0].q_rad.tolist() == TABLE.select("q1", "q2", "q3").to_numpy().tolist()
    sheet(TABLE, tmp_path / "b.xlsx", edit=lambda page: (page.delete_rows(1), put(B3="x")(page)))
    says(small.error(), "row 3 (Sheet1!B3), column 'c2' (q2): got 'x'")


def other_archive(path: Path, **parts: str) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name.replace("__", "/").replace("_dot_", "."), content)


def test_what_is_no_such_workbook(tmp_path: Path) -> None:
    other_archive(tmp_path / "a.ods", mimetype="application/vnd.oasis.opendocument.spreadsheet")
    says(told(tmp_path, "a.ods"), "a.ods: this is an OpenDocument file", "Save the table as .xlsx or CSV")
    other_archive(tmp_path / "a.xlsb", xl__workbook_dot_bin="")
    says(told(tmp_path, "a.xlsb"), "a.xlsb: this is a binary Excel workbook")
    other_archive(tmp_path / "a.zip", readings_dot_csv=BARS)
    says(told(tmp_path, "a.zip"), "a.zip: this is a zip archive")
    (tmp_path / "a.xls").write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(1000))
    says(
        told(tmp_path, "a.xls"),
        "a.xls: this is an old Excel workbook (.xls), or one with a password",
        "Save it as .xlsx",
    )


def test_damaged_workbooks(tmp_path: Path) -> None:
    sheet(TABLE, tmp_path / "good.xlsx")
    content = (tmp_path / "good.xlsx").read_bytes()
    (tmp_path / "b.xlsx").write_bytes(content[: len(content) // 2])
    says(told(tmp_path, "b.xlsx"), "b.xlsx: this looks like an Excel workbook, but cannot be read", "Save it again")
    with zipfile.ZipFile(tmp_path / "good.xlsx") as good, zipfile.ZipFile(tmp_path / "b.xlsx", "w") as bad:
        for name in good.namelist():
            bad.writestr(name, good.read(name)[: 300 if "sheet1" in name else None])
    says(told(tmp_path, "b.xlsx"), "b.xlsx: this looks like an Excel workbook, but cannot be read (", "Save it again")


def test_any_byte_may_be_wrong(tmp_path: Path) -> None:
    """A message or readings, never anything else."""
    small = SmallStudy(tmp_path)
    small.write("study.toml", STUDY.replace("bars.csv", "b.xlsx"))
    sheet(TABLE, tmp_path / "b.xlsx")
    content = (tmp_path / "b.xlsx").read_bytes()
    refused = 0
    for k in range(0, len(content), 37):
        small.write("b.xlsx", content[:k] + bytes([content[k] ^ 0x55]) + content[k + 1 :])
        refused += small.refuses()
    assert refused > 20


@pytest.mark.parametrize("turned", [0x01, 0x55, 0x80, 0xFF])
def test_any_byte_of_the_headers_may_be_wrong(tmp_path: Path, turned: int) -> None:
    """Sizes, offsets and methods of the archive's parts: what looks into it finds a cell, or none."""
    sheet(TABLE, tmp_path / "good.xlsx")
    content = (tmp_path / "good.xlsx").read_bytes()
    local = [start + k for start in starts(content, b"PK\x03\x04") for k in range(30)]
    directory = range(content.index(b"PK\x01\x02"), len(content))
    for k in [*local, *directory]:
        (tmp_path / "b.xlsx").write_bytes(content[:k] + bytes([content[k] ^ turned]) + content[k + 1 :])
        assert far_cell(tmp_path / "b.xlsx", "Sheet1") is None
        assert len(stored_cell(tmp_path / "b.xlsx", "Sheet1", "B4")) == 2


def starts(content: bytes, mark: bytes) -> list[int]:
    return [match.start() for match in re.finditer(re.escape(mark), content)]


@pytest.mark.parametrize("far", ["AMJ50000", "AMJ1048576", "XFD1048576"])
def test_a_note_at_the_end_of_the_sheet(tmp_path: Path, far: str) -> None:
    """What a spreadsheet's last cell costs is said, and not paid: a workbook of 5 kB would need gigabytes."""
    sheet(TABLE, tmp_path / "b.xlsx", edit=put(**{far: "note"}))
    message = told(tmp_path, "b.xlsx")
    says(message, str(tmp_path / "b.xlsx"), f"Sheet1!{far}")


def test_a_wide_sheet_is_no_stray_cell(tmp_path: Path) -> None:
    wide = TABLE.with_columns(pl.lit("x").alias(f"note{k}") for k in range(60))
    sheet(wide, tmp_path / "b.xlsx")
    assert far_cell(tmp_path / "b.xlsx", "Sheet1") is None
