"""A table in memory as a table of a file would be: the same checks, the same messages, no file.

It is no row of `registry.py`: nothing has to be recognised, the caller has it.
"""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import polars as pl

from ulna.formats.cells import bad_cell, labels_of, names_of, no_numbers
from ulna.formats.frames import as_frame
from ulna.formats.header import Header, Numeric
from ulna.formats.layout import Layout
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class FrameTable(Header):
    """A frame."""

    frame_: pl.DataFrame = field(kw_only=True, repr=False)

    @property
    def head(self) -> str:
        return "the names of its columns"

    @property
    def rows(self) -> int:
        return len(self.frame_)

    def where(self, row: int) -> str:
        return f"row {row} (counted from 1)"

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        found = []
        for name in columns:
            column = self.frame_[self.own(name)].rename(name)
            if numeric(name) and not column.dtype.is_numeric():
                present = column.drop_nulls()
                if len(present):
                    row = int(column.is_not_null().arg_true()[0]) + 1
                    raise UlnaInputError(no_numbers(self, row, name, present[0], str(column.dtype)))
            found.append(column.cast(pl.Float64) if numeric(name) else labels_of(self, name, column))
        return pl.DataFrame(found)

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        value = self.frame_[self.own(column)][row - 1]
        return bad_cell(self, row, column, "" if value is None or value != value else str(value), numeric)

    def with_units(self, units: dict[str, str]) -> FrameTable:
        """The same, its columns said to be in these units: own name → unit."""
        return dataclasses.replace(self, units={**self.units, **units})

    @property
    def sha256(self) -> str:
        """Of names and cells: the same whatever library the frame was of."""
        known = hashlib.sha256()
        for name in self.frame_.columns:
            column = self.frame_[name]
            cells = column.cast(pl.Float64) if column.dtype.is_numeric() else names_of(column)
            known.update(repr((name, cells.to_list())).encode())
        return known.hexdigest()


def frame_table(given: Any, label: str, layout: Layout, what: str = "a table") -> FrameTable:
    """A table in memory, its columns under their own names. Raises UlnaInputError; TypeError for what is no table."""
    frame = as_frame(given, label)
    for name in layout.fill_down:
        own = layout.columns.get(name, name)
        filled = names_of(frame[own]).str.strip_chars().replace("", None).forward_fill()
        frame = frame.with_columns(filled.alias(own))
    return FrameTable(Path(label), list(frame.columns), what=what, frame_=frame)
