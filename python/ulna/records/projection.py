"""The rows of the index that follow from an entry and its files, and from nothing else."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Table

from ulna.records.acts.registry import act_of
from ulna.records.entry import Entry
from ulna.records.store import Store


def rows_of(entry: Entry, files: Store) -> dict[Table, list[dict[str, Any]]]:
    """By table, each with every column. Raises UlnaInputError for an act that nobody knows, or files that are
    damaged."""
    made: dict[Table, list[dict[str, Any]]] = {}
    for table, row in act_of(entry.act).rows(entry, files):
        rows = made.setdefault(table, [])
        empty = dict.fromkeys((column.name for column in table.columns), None)
        rows.append({**empty, **row, "seq": entry.seq, "line": len(rows) + 1})
    return made
