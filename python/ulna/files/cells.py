"""Finding the first bad cell of a table, to tell it in one message: file, row, column, value, what was expected.

Rows are data rows counted from 1, the header not counted; for a CSV file its line is named beside.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from ulna.errors import UlnaInputError

#: true for the name of a column that holds numbers
Numeric = Callable[[str], bool]

WHAT = "a table (CSV with commas and a header, or Parquet)"


@dataclass(frozen=True)
class Header:
    """What is known of a table before its rows are read."""

    path: Path
    columns: list[str]
    is_csv: bool
    lines: int = 1
    """Lines of the header; 0 where others' files have none."""
    separator: str = ","
    decimal_comma: bool = False

    def where(self, row: int) -> str:
        """How a message calls a data row: with its line where the file has lines."""
        return f"row {row} (line {row + self.lines} of the file)" if self.is_csv else f"row {row}"


def name_bad_cell(header: Header, numeric: Numeric) -> None:
    """Go through a CSV file cell by cell and raise for the first bad one; return where every cell is fine."""
    numbers = [numeric(name) for name in header.columns]
    row = 0
    try:
        with header.path.open(encoding="utf-8-sig", newline="") as stream:
            reader = csv.reader(stream, delimiter=header.separator)
            for _ in range(header.lines):
                next(reader)
            blank = 0
            for row, cells in enumerate(reader, start=1):
                if not cells:
                    blank = blank or row
                    continue
                if blank:
                    raise UlnaInputError(
                        f"{header.path}: {header.where(blank)} is blank; expected a reading. Remove the line."
                    )
                if len(cells) != len(numbers):
                    _wrong_count(header, row, cells, sum(numbers))
                for name, cell, is_number in zip(header.columns, cells, numbers, strict=True):
                    value = number_of(cell, header.decimal_comma) if is_number else 0.0
                    if value is None or value - value != 0.0 or not cell.strip():
                        raise UlnaInputError(bad_cell(header, row, name, cell, numeric))
    except UnicodeDecodeError as error:
        raise UlnaInputError(
            f"{header.path}: the file is not UTF-8 text (byte 0x{error.object[error.start]:02x}); expected {WHAT}. "
            "Save it as UTF-8."
        ) from None
    except csv.Error as error:
        # A cell of 131072 characters is what follows a quotation mark that nobody closes.
        what = "a quotation mark is not closed" if "field limit" in str(error) else str(error)
        raise UlnaInputError(f"{header.path}: {header.where(row + 1)}: {what}; expected {WHAT}. Correct it.") from None


def _wrong_count(header: Header, row: int, cells: list[str], numbers: int) -> NoReturn:
    hint = "Correct the row."
    if len(cells) >= len(header.columns) + numbers // 2 and numbers > 1:
        hint = "Are these decimal commas? Write numbers with a decimal point."
    elif len(cells) == 1 and ";" in cells[0]:
        hint = "Are the columns separated by semicolons? Write commas between them and points in numbers."
    elif any("\n" in cell for cell in cells):
        hint = "Is a quotation mark not closed? A cell runs over several lines."
    count = f"{len(cells)} cell{'s' * (len(cells) != 1)}"
    raise UlnaInputError(
        f"{header.path}: {header.where(row)} has {count}, expected {len(header.columns)} as in the header "
        f"({', '.join(header.columns)}). {hint}"
    )


def bad_cell(header: Header, row: int, column: str, cell: str, numeric: Numeric) -> str:
    """The message for a cell that is empty, no number or no finite number."""
    at = f"{header.path}: {header.where(row)}, column '{column}'"
    if not cell.strip():
        return (
            f"{at}: the cell is empty; expected a {'number' if numeric(column) else 'name'}. Fill it or remove the row."
        )
    if not header.decimal_comma and re.fullmatch(r"\s*[+-]?\d*,\d+([eE][+-]?\d+)?\s*", cell):
        return (
            f"{at}: got '{cell}', a decimal comma; expected a number with a decimal point. Export the table again so."
        )
    kind = "a finite number" if number_of(cell, header.decimal_comma) is not None else "a number"
    return f"{at}: got '{cell[:60]}', expected {kind}. Correct it or remove the row."


def number_of(cell: str, decimal_comma: bool = False) -> float | None:
    """The number that a cell holds, in Polars' spelling of numbers."""
    try:
        return None if "_" in cell else float(cell.replace(",", ".") if decimal_comma else cell)
    except ValueError:
        return None
