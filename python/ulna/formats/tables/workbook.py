"""Excel workbooks (.xlsx): one sheet as a table, its first row the header.

Calamine reads the values. A cell that cannot be used is looked at once more in the file itself (workbook_cell.py),
because a formula that nobody has computed, an error and a merged cell are all empty to it.
"""

from __future__ import annotations

import datetime
import re
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import polars as pl
from python_calamine import CalamineError, CalamineSheet, CalamineWorkbook, SheetTypeEnum

from ulna.formats.cells import bad_cell, is_decimal_comma, number_of
from ulna.formats.header import Numeric
from ulna.formats.layout import Layout
from ulna.formats.places import Places
from ulna.formats.tables.grid import GridTable, lay_out
from ulna.formats.tables.heads import is_blank
from ulna.formats.tables.marks import OLD_OFFICE
from ulna.formats.tables.workbook_cell import address, far_cell, stored_cell
from ulna.formats.tables.workbook_parts import check_parts
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded

Cell = str | float | bool | datetime.date | datetime.time | datetime.timedelta


@dataclass(frozen=True)
class SheetTable(GridTable):
    """One sheet of a workbook, read whole."""

    sheet: str
    merged: list[tuple[tuple[int, int], tuple[int, int]]] = field(repr=False)
    """First and last cell (row, column from 0) of merged ones."""

    @property
    def head(self) -> str:
        return f"row {self.header_line or 1} of sheet '{self.sheet}'"

    def where(self, row: int) -> str:
        return f"row {row} (row {self.lines[row - 1]} of sheet '{self.sheet}')"

    def at(self, row: int, column: str) -> str:
        cell = address(self.sheet, self.lines[row - 1] - 1, self.places[self.columns.index(column)])
        return f"row {row} ({cell}), {self.named(column)}"

    @property
    def row_places(self) -> Places:
        return Places(address(self.sheet, 0, self.places[0]).removesuffix("1") + "{}", self.lines)

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        found = []
        for name in columns:
            values = self.values(name)
            if numeric(name):
                plain = [value if type(value) in (int, float) else None for value in values]
                found.append(pl.Series(name, plain, dtype=pl.Float64))
            else:
                found.append(pl.Series(name, [_name(value) for value in values], dtype=pl.String))
        return pl.DataFrame(found)

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        line, k = self.lines[row - 1] - 1, self.places[self.columns.index(column)]
        value: Cell = self.value(row, column)
        at = f"{self.path}: {self.at(row, column)}"
        kind = "number" if numeric(column) else "name"
        if is_blank(value):
            formula, text = stored_cell(self.path, self.sheet, address("", line, k))
            if text.startswith("#"):
                return f"{at}: got the error {text}; expected a {kind}. Correct what it comes from, or remove the row."
            if formula is not None:
                return (
                    f"{at}: got the formula '={formula[:40]}', whose result is not in the file; expected a {kind}. "
                    "Open the workbook in Excel or LibreOffice and save it: that computes its formulas."
                )
            for (top, left), (bottom, right) in self.merged:
                if top <= line <= bottom and left <= k <= right:
                    area = f"{address('', top, left)}:{address('', bottom, right)}"
                    return (
                        f"{at}: is one of the merged cells {area}, of which only the first has a value; expected a "
                        f"{kind} in each. Unmerge them and fill each."
                    )
        elif isinstance(value, datetime.date | datetime.time | datetime.timedelta):
            return (
                f"{at}: got the date or time '{_name(value)}', expected a number. Format the cells as numbers, and "
                "enter again what was taken for a date."
            )
        elif isinstance(value, str) and (number_of(value) is not None or is_decimal_comma(value)):
            return (
                f"{at}: got '{value[:40]}' as a text, expected a number. Turn the texts of this column into numbers, "
                "or write them again with numbers."
            )
        return bad_cell(self, row, column, str(_name(value) or ""), numeric)


def _name(value: Cell) -> str | None:
    """A cell as a label: 3 and not 3.0, as it is shown and as it would be in a CSV file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() else repr(value)
    if isinstance(value, datetime.datetime):
        return value.isoformat(sep=" ").removesuffix(" 00:00:00")
    return str(value) or None


def open_workbook(path: Path, start: bytes, what: str, layout: Layout) -> SheetTable:
    """One sheet of a workbook. Raises UlnaInputError for other archives, damaged ones, and a sheet left open."""
    _check_kind(path, start, what)
    try:
        workbook = CalamineWorkbook.from_path(path)
        names = [each.name for each in workbook.sheets_metadata if each.typ == SheetTypeEnum.WorkSheet]
        name = _chosen(names, path, layout)
        far = far_cell(path, name)
        if far is not None:
            raise UlnaInputError(
                f"{path}: {address(name, 0, 0)[:-2]}{far} holds something far from all else, with millions of empty "
                f"cells between; expected {what}. Clear that cell, or copy the table to a sheet of its own."
            )
        sheet = workbook.get_sheet_by_name(name)
        return _table(path, sheet, sheet.to_python(skip_empty_area=False), layout)
    except CalamineError as error:
        raise _unreadable(path, what, error) from None


def _unreadable(path: Path, what: str, error: Exception) -> UlnaInputError:
    reason = " ".join(str(error).split())
    reason = reason if len(reason) > 3 else type(error).__name__
    return UlnaInputError(
        f"{path}: this looks like an Excel workbook, but cannot be read ({reason}); expected {what}. Save it again as "
        ".xlsx. Export the sheet as CSV where that does not help."
    )


def _check_kind(path: Path, start: bytes, what: str) -> None:
    """What else is a zip archive, or was once an Excel workbook."""
    if start.startswith(OLD_OFFICE):
        raise UlnaInputError(
            f"{path}: this is an old Excel workbook (.xls), or one with a password; expected {what}. Save it as .xlsx "
            "without a password."
        )
    try:
        with zipfile.ZipFile(path) as archive:
            inside = set(archive.namelist())
            check_parts(path, archive)
    except (zipfile.BadZipFile, zlib.error, OSError, ValueError, NotImplementedError) as error:
        raise _unreadable(path, what, error) from None
    if "[Content_Types].xml" in inside and any(re.match(r"xl/.*\.xml", name) for name in inside):
        return
    kind = "a zip archive"
    if "xl/workbook.bin" in inside:
        kind = "a binary Excel workbook (.xlsb)"
    elif "mimetype" in inside:
        kind = "an OpenDocument file"
    raise UlnaInputError(f"{path}: this is {kind}; expected {what}. Save the table as .xlsx or CSV.")


def _chosen(names: list[str], path: Path, layout: Layout) -> str:
    if layout.sheet is not None:
        if layout.sheet not in names:
            raise UlnaInputError(
                f"{layout.key('sheet')}: got '{layout.sheet}', but {path} has no such sheet."
                f"{nearest(layout.sheet, names)} Correct it."
            )
        return layout.sheet
    if len(names) != 1:
        raise UlnaInputError(
            f"{path}: there are {len(names)} sheets ({', '.join(names)[:200]}); expected to be told which. Say "
            f"{layout.say('sheet', names[0] if names else '…')}, or whichever it is."
        )
    return names[0]


def _table(path: Path, sheet: CalamineSheet, grid: list[list[Any]], layout: Layout) -> SheetTable:
    while grid and all(map(is_blank, grid[-1])):  # rows that were cleared, or only have a colour
        grid.pop()
    if not grid:
        raise UlnaInputError(f"{path}: sheet '{sheet.name}' is empty; expected a table. Name another sheet or file.")
    merged = list(sheet.merged_cell_ranges or ())
    remarks = _fill_merged(path, grid, merged, sheet.name)
    lines = list(range(1, len(grid) + 1))
    grid = [[_name(cell) if isinstance(cell, bool) else cell for cell in row] for row in grid]
    laid = lay_out(
        path,
        grid,
        lines,
        layout,
        lambda line: f"row {line} of sheet '{sheet.name}'",
        lambda line, k: address(sheet.name, line - 1, k),
    )
    names = laid.names if laid.header_line else [f"c{k + 1}" for k in laid.places]
    return SheetTable(
        path,
        names,
        sheet=sheet.name,
        lines=laid.lines,
        grid=laid.grid,
        places=laid.places,
        header_line=laid.header_line,
        units=laid.units,
        remarks=[worded("{of}: {why}", of=str(path), why=remark) for remark in [*remarks, *laid.remarks]],
        merged=merged,
    )


def _fill_merged(
    path: Path, grid: list[list[Any]], merged: list[tuple[tuple[int, int], tuple[int, int]]], sheet: str
) -> list[str]:
    """What stands in merged cells stands in each row of them: only the first has it in the file. Rows that are merged
    across columns are titles, and are left."""
    found = []
    left_to_fill = sum(map(len, grid)) + len(grid)  # as cells are merged once, no more than there are
    for (top, left), (bottom, right) in sorted(merged):
        if left != right or top >= len(grid) or left >= len(grid[top]) or is_blank(grid[top][left]):
            continue
        for row in grid[top + 1 : bottom + 1]:
            row += [""] * (left + 1 - len(row))
            row[left] = grid[top][left]
        left_to_fill -= len(grid[top + 1 : bottom + 1])
        if left_to_fill < 0:
            raise UlnaInputError(
                f"{path}: sheet '{sheet}': merged cells lie upon each other, as the file says; expected each cell to "
                "be merged once. It is damaged: open and save it in Excel or LibreOffice."
            )
        found.append(f"{address('', top, left)}:{address('', bottom, left)}")
    if not found:
        return []
    shown = ", ".join(found[:8]) + (f", … ({len(found)} in all)" if len(found) > 8 else "")
    return [f"sheet '{sheet}': what stands in merged cells counts for each of their rows: {shown}."]
