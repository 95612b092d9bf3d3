"""How a bad cell is told, in one message: file, row, column, value, what was expected; and what cells mean."""

from __future__ import annotations

import re
from typing import Any

import polars as pl

from ulna.formats.header import Header, Numeric


def bad_cell(header: Header, row: int, column: str, cell: str, numeric: Numeric, decimal: str = ".") -> str:
    """The message for a cell that is empty, no number or no finite number."""
    at = f"{header.path}: {header.at(row, column)}"
    if not cell.strip():
        kind = "number" if numeric(column) else "name"
        return f"{at}: the cell is empty; expected a {kind}. Fill it or remove the row."
    kind = "a finite number" if number_of(cell, decimal) is not None else "a number"
    return f"{at}: got '{cell[:60]}', expected {kind}. Correct it or remove the row."


def no_numbers(header: Header, row: int, column: str, value: Any, kind: str) -> str:
    """The message about a typed column of another type."""
    return (
        f"{header.path}: {header.at(row, column)}: got {value!r} ({kind}), expected a number. Write the column as "
        "floating-point numbers."
    )


def number_of(cell: str, decimal: str = ".") -> float | None:
    """The number that a text holds, in Polars' spelling of numbers: no thousands separators, no underscores."""
    if "_" in cell or (decimal == "," and "." in cell):
        return None
    try:
        return float(cell.replace(",", ".") if decimal == "," else cell)
    except ValueError:
        return None


def is_decimal_comma(cell: str) -> bool:
    """Whether a text would be a number if its comma were a point."""
    return re.fullmatch(r"\s*[+-]?\d*,\d+([eE][+-]?\d+)?\s*", cell) is not None


def names_of(column: pl.Series) -> pl.Series:
    """Any column as String: a whole number without a point, so that a label is the same in every format."""
    if not column.dtype.is_float():
        return column.cast(pl.String)
    whole = column.is_finite() & (column == column.round()) & (column.abs() < 2**53)
    text = column.set(column.is_nan().fill_null(False), None).cast(pl.String)
    return (
        column.set(~whole.fill_null(False), None).cast(pl.Int64).cast(pl.String).zip_with(whole.fill_null(False), text)
    )
