"""The rows of the index that follow from an entry and its files, and from nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from sqlalchemy import Boolean, Column, Double, Integer, Table

from ulna.ground.errors import UlnaInputError
from ulna.records.acts.act import Row
from ulna.records.acts.registry import act_of
from ulna.records.entry import Entry
from ulna.records.store import Store


def rows_of(entry: Entry, files: Store) -> dict[Table, list[dict[str, Any]]]:
    """By table, each with every column. Raises UlnaInputError for an act that nobody knows, or files that are
    damaged."""
    made: dict[Table, list[dict[str, Any]]] = {}
    for table, row in stated_rows(act_of(entry.act).rows(entry, files), f"record: entry {entry.seq}"):
        rows = made.setdefault(table, [])
        empty = dict.fromkeys((column.name for column in table.columns), None)
        rows.append({**empty, **row, "seq": entry.seq, "line": len(rows) + 1})
    return made


def stated_rows(rows: Iterable[Row], where: str) -> list[Row]:
    """All of them, each value such as every database holds it: text without a character 0, in UTF-8; finite numbers.

    Raises UlnaInputError where one is not, or where what they follow from lacks something.
    """
    try:
        found = list(rows)
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError, RecursionError) as error:
        raise UlnaInputError(
            f"{where}: its figures cannot be read out of it ({type(error).__name__}: {error}); expected a file as Ulna "
            "writes it. It was changed or damaged: make it anew."
        ) from None
    for table, row in found:
        for name, value in row.items():
            if not _held(table.columns[name], value):
                raise UlnaInputError(
                    f"{where}: {table.name} {row.get('name', '')!r}, {name}: got {value!r:.60}, which a record cannot "
                    f"hold; expected {_expected(table.columns[name])}. Correct it."
                )
    return [(table, {name: _same(value) for name, value in row.items()}) for table, row in found]


def _same(value: object) -> object:
    """SQLite keeps no sign of zero, PostgreSQL does: none is kept."""
    return 0.0 if isinstance(value, float) and value == 0.0 else value


def _held(column: Column[Any], value: object) -> bool:
    if value is None:
        return bool(column.nullable)
    if isinstance(column.type, Boolean):
        return isinstance(value, bool)
    if isinstance(column.type, Double | Integer):
        return isinstance(value, int | float) and not isinstance(value, bool) and _finite(value)
    return isinstance(value, str) and "\0" not in value and _utf8(value)


def _finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer that no number of a database is as large as
        return False


def _utf8(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _expected(column: Column[Any]) -> str:
    if isinstance(column.type, Boolean):
        return "true or false"
    return "a finite number" if isinstance(column.type, Double | Integer) else "text"
