"""How a bad cell is told, in one message: file, row, column, value, what was expected; and what cells mean."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import polars as pl

from ulna.formats.header import Header, Numeric
from ulna.formats.layout import Layout
from ulna.formats.spelling import MOST, PLAIN, Spelling, sexagesimal, thousands_of
from ulna.ground.errors import UlnaInputError


def bad_cell(header: Header, row: int, column: str, cell: str, numeric: Numeric, decimal: str = ".") -> str:
    """The message for a cell that is empty, no number, or none of a size that quantities have."""
    at = f"{header.path}: {header.at(row, column)}"
    if not cell.strip():
        kind = "number" if numeric(column) else "name"
        return f"{at}: the cell is empty; expected a {kind}. Fill it or remove the row."
    number = number_of(cell, decimal)
    if number is not None and MOST < abs(number) < math.inf:
        return (
            f"{at}: got '{cell if len(cell) <= 60 else number}', more than any quantity is; expected a number up to "
            f"{MOST:g} in size. Correct it or remove the row."
        )
    kind = "a finite number" if number is not None else "a number"
    return f"{at}: got '{cell[:60]}', expected {kind}. Correct it or remove the row."


def text_cell(
    header: Header, row: int, column: str, cell: str, numeric: Numeric, layout: Layout, no_header: bool
) -> str:
    """The same of a cell of a text: what stands there may be a number in another spelling than the file is said to
    have. no_header: whether the cell is in the first row of a file that is said to have no header."""
    at = f"{header.path}: {header.at(row, column)}"
    decimal = layout.decimal or "."
    if numeric(column) and decimal == "." and not layout.thousands and is_decimal_comma(cell):
        say = "" if layout.separator in (None, ",") else f"Say {layout.say('decimal', ',')}, or export"
        return (
            f"{at}: got '{cell}', a decimal comma; expected a number with a decimal point. {say or 'Export'} the "
            "table again so."
        )
    pointed = "." in cell and number_of(cell.replace(".", ""), ",") is not None
    if numeric(column) and decimal == "," and not layout.thousands and pointed:
        return (
            f"{at}: got '{cell}', with a point; expected a number with a decimal comma ({layout.key('decimal')}). "
            f"Correct the key, say {layout.say('thousands', '.')} where points stand between thousands, or export the "
            "table again without them."
        )
    degrees = sexagesimal(cell)
    if numeric(column) and degrees is not None:
        return f"{at}: got '{cell[:60]}', {minutes_said(degrees)}"
    bare = cell.strip().removesuffix("°").rstrip()
    if numeric(column) and bare != cell.strip() and number_of(bare, decimal) is not None:
        return (
            f"{at}: got '{cell[:60]}', a number with its unit; expected '{bare}'. Write the unit once, in the heading "
            "or where the unit of angles is said (deg), and remove the sign from the cells."
        )
    sign = "" if layout.thousands else thousands_of(cell, decimal)
    if numeric(column) and sign:
        return (
            f"{at}: got '{cell[:60]}', expected a number. Say {layout.say('thousands', sign)} where that sign stands "
            "between thousands, or correct the cell."
        )
    if numeric(column) and no_header and cell.strip() and number_of(cell, decimal) is None:
        return (
            f"{at}: got '{cell[:60]}', expected a number, because the file is said to have no header "
            f"({layout.key('header')}). Correct the cell, or remove that where this is the header."
        )
    return bad_cell(header, row, column, cell, numeric, decimal)


def minutes_said(degrees: float) -> str:
    """The rest of a message about an angle in degrees, minutes and seconds."""
    return (
        f"degrees, minutes and seconds; expected decimal degrees, such as {degrees:.6f}. Write the column so, and say "
        "that angles are in deg."
    )


def some_of(names: Sequence[str], most: int = 12) -> str:
    """Names one after the other; of very many the first and the last."""
    return ", ".join(names if len(names) <= most else [*names[: most - 2], "…", names[-1]])


def wrong_count(header: Header, row: int, cells: list[str], width: int, separator: str, named: bool) -> str:
    """The message for a row of a text with more or fewer cells than the header (named) or the first row."""
    hint = "Correct the row."
    if separator == "," and len(cells) >= width + (width + 1) // 4 and width > 1:
        hint = "Are these decimal commas? Write numbers with a decimal point."
    elif len(cells) == 1 and separator != ";" and ";" in cells[0]:
        hint = f"Are the columns separated by semicolons? Write '{separator}' between them and points in numbers."
    elif any("\n" in cell for cell in cells):
        hint = "Is a quotation mark not closed? A cell runs over several lines."
    names = some_of(list(map(header.own, header.columns)))
    return (
        f"{header.path}: {header.where(row)} has {len(cells)} cell{'s' * (len(cells) != 1)}, expected {width} "
        f"{'as in the header' if named else 'as in the first line'} ({names}). {hint}"
    )


def no_numbers(header: Header, row: int, column: str, value: Any, kind: str) -> str:
    """The message about a typed column of another type."""
    return (
        f"{header.path}: {header.at(row, column)}: got {value!r} ({kind}), expected a number. Write the column as "
        "floating-point numbers."
    )


def number_of(cell: str, decimal: str = ".") -> float | None:
    """The number that a text holds: no thousands separators, no underscores."""
    return (PLAIN if decimal == "." else Spelling(decimal)).number(cell)


def is_decimal_comma(cell: str) -> bool:
    """Whether a text would be a number if its comma were a point."""
    return re.fullmatch(r"\s*[+-]?\d*,\d+([eE][+-]?\d+)?\s*", cell) is not None


def labels_of(header: Header, name: str, column: pl.Series) -> pl.Series:
    """A typed column of labels as String. Raises UlnaInputError for a type that holds none, or dates beyond dates."""
    reason = _unfit(column)
    if reason is None:
        try:
            return names_of(column)
        except pl.exceptions.PolarsError as error:
            reason = f" ({str(error).splitlines()[0][:80]})" if str(error) else ""
    raise UlnaInputError(
        f"{header.path}: {header.named(name)} is of type {column.dtype}{reason}; expected texts or whole numbers as "
        "labels. Write it as texts."
    )


def _unfit(column: pl.Series) -> str | None:
    """Why Polars must not be asked for texts: it would end the process. None where it may."""
    if column.dtype.is_nested():
        return ""
    zone = getattr(column.dtype, "time_zone", None)
    if zone is not None and not _is_zone(zone):
        return ", a time zone that is nowhere"
    return ", beyond all dates" if column.dtype.is_temporal() and not _are_dates(column) else None


def _is_zone(name: str) -> bool:
    try:
        pl.Series([0], dtype=pl.Datetime("us")).dt.replace_time_zone(name)
    except pl.exceptions.PolarsError:
        return False
    return True


_DAYS = 2_932_896
"""From 1970 to the year 9999."""
_PER_DAY = {"ms": 86_400_000, "us": 86_400_000_000, "ns": 86_400_000_000_000}


def _are_dates(column: pl.Series) -> bool:
    """Whether times of a column are such that people have a calendar for: Polars ends the process at others."""
    if column.dtype == pl.Time:
        return True
    if column.dtype == pl.Date:
        per_day = 1
    elif isinstance(column.dtype, pl.Datetime):
        per_day = _PER_DAY[column.dtype.time_unit]
    else:
        return False
    largest = column.to_physical().cast(pl.Float64).abs().max()
    return largest is None or bool(float(str(largest)) <= _DAYS * per_day)


def first_of(column: pl.Series) -> object:
    """Its first value, to be shown; of times the number that stands for it where no calendar has it."""
    if not len(column):
        return None
    return column.to_physical()[0] if column.dtype.is_temporal() else column[0]


def names_of(column: pl.Series) -> pl.Series:
    """Any column as String: a whole number without a point, so that a label is the same in every format."""
    if not column.dtype.is_float():
        return column.cast(pl.String)
    whole = column.is_finite() & (column == column.round()) & (column.abs() < 2**53)
    text = column.set(column.is_nan().fill_null(False), None).cast(pl.String)
    return (
        column.set(~whole.fill_null(False), None).cast(pl.Int64).cast(pl.String).zip_with(whole.fill_null(False), text)
    )
