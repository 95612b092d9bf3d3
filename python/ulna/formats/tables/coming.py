"""A table that comes as it is made, from a pipe: each row is there as soon as its line is, memory stays bounded.

Lines of text alone can come so. What needs the whole file to be seen, titles above the header or an encoding that
nobody states, is not seen here: the first line that holds anything names the columns, unless it is said otherwise.
"""

from __future__ import annotations

import codecs
import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO, Protocol, cast

import numpy as np
import polars as pl

from ulna.formats.cells import text_cell, wrong_count
from ulna.formats.header import Header, Numeric, Piece
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.spelling import usable
from ulna.formats.tables.grid import DITTO
from ulna.formats.tables.heads import UNITS
from ulna.formats.tables.registry import FORMATS
from ulna.formats.tables.text import check_separator
from ulna.ground.errors import UlnaInputError, nearest

LABEL = Path("standard input")
"""How messages call it."""
_BLOCK_BYTES = 1 << 16
_LONGEST = 1 << 20
"""Of a line, bytes: no row of readings comes near it."""

Numbered = list[tuple[int, str]]
"""Lines with their numbers, from 1."""


class _Raw(Protocol):
    def read1(self, size: int, /) -> bytes: ...


class Lines:
    """The lines of a pipe, as they come."""

    def __init__(self, pipe: BinaryIO, what: str, layout: Layout) -> None:
        self._pipe, self._what = cast(_Raw, pipe), what
        self._rest, self._count, self._ended = b"", 0, False
        self._waiting: Numbered = []
        self._encoding = layout.encoding or "utf-8"
        if len("\n".encode(self._encoding)) != 1:
            raise UlnaInputError(
                f"{layout.key('encoding')}: got '{layout.encoding}', whose lines cannot be told apart as they come; "
                f"expected such as utf-8 or cp1252 of {LABEL}. Write it so, or name a file."
            )

    def back(self, lines: Numbered) -> None:
        """Lines that are to come once more."""
        self._waiting = [*lines, *self._waiting]

    def first(self) -> tuple[int, str] | None:
        """The next line; None at the end."""
        some = self.some()
        self.back(some[1:])
        return some[0] if some else None

    def some(self) -> Numbered:
        """Those that have come, at least one; [] at the end. Raises UlnaInputError for what is no text."""
        if self._waiting:
            found, self._waiting = self._waiting, []
            return found
        while not self._ended:
            block = self._pipe.read1(_BLOCK_BYTES)
            if not self._count and not self._rest:
                self._refuse_binary(block)
            self._ended = not block
            *lines, self._rest = (self._rest + block).split(b"\n")
            if self._ended and self._rest:
                lines.append(self._rest)
            if len(self._rest) > _LONGEST:
                raise UlnaInputError(
                    f"{LABEL}: line {self._count + len(lines) + 1} does not end within {_LONGEST >> 20} MB; expected "
                    f"{self._what}. Correct it."
                )
            if lines:
                return [self._text(line) for line in lines]
        return []

    def _text(self, line: bytes) -> tuple[int, str]:
        self._count += 1
        line = line.removeprefix(codecs.BOM_UTF8) if self._count == 1 else line
        try:
            return self._count, line.decode(self._encoding).rstrip("\r")
        except UnicodeDecodeError as error:
            raise UlnaInputError(
                f"{LABEL}: line {self._count}: the byte 0x{line[error.start]:02x} is no {self._encoding} text; "
                f"expected {self._what}. Say --encoding cp1252, or whichever it is."
            ) from None

    def _refuse_binary(self, start: bytes) -> None:
        found = next((each for each in FORMATS[:-1] if each.recognised(start)), None)
        if found is not None:
            raise UlnaInputError(
                f"{LABEL}: this is {found.kind}, which has to be read whole; expected lines of text. Name the file."
            )


@dataclass(frozen=True)
class ComingTable(Header):
    """A table of lines that are yet to come."""

    lines: Lines
    separator: str
    layout: Layout = AS_EXPECTED
    place: dict[int, int] = field(default_factory=dict)
    """Of the rows at hand: row → line."""

    @property
    def head(self) -> str:
        return "the first line"

    def where(self, row: int) -> str:
        return f"row {row} (line {self.place[row]})" if row in self.place else f"row {row}"

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        """All rows that are yet to come, once."""
        numbers, texts = ([c for c in columns if numeric(c) == each] for each in (True, False))
        pieces = list(self.pieces(numbers, texts, 0))
        values = np.concatenate([np.empty((0, len(numbers))), *(piece.numbers for piece in pieces)])
        found = {name: pl.Series(name, np.ascontiguousarray(values[:, k])) for k, name in enumerate(numbers)}
        empty = {name: pl.Series(name, [], dtype=pl.String) for name in texts}
        found |= {name: pl.concat([empty[name], *(piece.texts[name] for piece in pieces)]) for name in texts}
        return pl.DataFrame([found[name] for name in columns])

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        return text_cell(self, row, column, "", numeric, self.layout, False)  # a gap is all that `cells` can leave

    def pieces(self, numbers: Sequence[str], texts: Sequence[str], rows: int) -> Iterator[Piece]:
        """As they come. Rows before a bad one come before its error: they were good."""
        above = dict.fromkeys(self._filled_down(), "")
        before = 0
        blank: int | None = None
        while lines := self.lines.some():
            self.place.clear()
            kept: list[tuple[list[float], list[str]]] = []
            error: UlnaInputError | None = None
            for line, text in lines:
                if not text.strip():
                    blank = line if blank is None else blank
                    continue
                if self.layout.comment is not None and text.startswith(self.layout.comment):
                    continue
                self.place[before + len(kept) + 1] = line
                try:
                    if blank is not None:
                        raise UlnaInputError(
                            f"{self.path}: line {blank} is blank; expected a reading. Remove the line."
                        )
                    kept.append(self._checked(text, before + len(kept) + 1, numbers, texts, above))
                except UlnaInputError as found:
                    error = found
                    break
            if kept:
                yield self._piece(kept, numbers, texts, before)
                before += len(kept)
            if error is not None:
                raise error

    def _checked(
        self, text: str, row: int, numbers: Sequence[str], texts: Sequence[str], above: dict[str, str]
    ) -> tuple[list[float], list[str]]:
        """The numbers and the names of a line. Raises UlnaInputError for a bad cell."""
        cells = cells_of(text, self.separator)
        if len(cells) != len(self.columns):
            named = self.layout.header is not False
            raise UlnaInputError(wrong_count(self, row, cells, len(self.columns), self.separator, named))
        by_name = dict(zip(self.columns, cells, strict=True))
        for name, last in above.items():
            cell = by_name[name].strip()
            if not cell or cell.casefold() in DITTO:
                by_name[name] = last
            above[name] = by_name[name]
        number = self.layout.spelling.number
        values, labels = [], []
        for name in numbers:
            value = number(by_name[name])
            if value is None or not usable(value):
                raise UlnaInputError(self._bad(row, name, by_name[name], numbers))
            values.append(value)
        for name in texts:
            cell = by_name[name].strip()
            if not cell:
                raise UlnaInputError(self._bad(row, name, cell, numbers))
            labels.append(self.labels.get(name, {}).get(cell, cell))
        return values, labels

    def _filled_down(self) -> list[str]:
        """The columns whose gaps mean the cell above. Raises UlnaInputError for a name of nothing."""
        found = []
        for name in self.layout.fill_down:
            column = self.find(name)
            if column is None:
                raise UlnaInputError(
                    f"{self.layout.key('fill_down')}: there is no column '{name}' in {self.path}."
                    f"{nearest(name, self.columns)} Correct it."
                )
            found.append(column)
        return found

    def _bad(self, row: int, name: str, cell: str, numbers: Sequence[str]) -> str:
        first = row == 1 and self.layout.header is False
        return text_cell(self, row, name, cell, lambda column: column in numbers, self.layout, first)

    def _piece(
        self, rows: list[tuple[list[float], list[str]]], numbers: Sequence[str], texts: Sequence[str], before: int
    ) -> Piece:
        values = np.array([own for own, _ in rows], dtype=np.float64).reshape(len(rows), len(numbers))
        named = {name: pl.Series(name, [labels[k] for _, labels in rows]) for k, name in enumerate(texts)}
        return Piece(before, values, named)


def cells_of(text: str, separator: str) -> list[str]:
    """Of one line. Raises UlnaInputError for a quotation mark that its line does not close."""
    if text.count('"') % 2:
        raise UlnaInputError(
            f"{LABEL}: a quotation mark is opened and not closed on its line: '{text[:60]}'; expected each row on one "
            "line. Close or remove it."
        )
    return next(csv.reader([text], delimiter=separator))


def coming_table(pipe: BinaryIO, what: str, layout: Layout) -> ComingTable:
    """The table that comes through a pipe: waits for the line that names its columns, and for the one after it.

    Raises UlnaInputError for what is no text, empty, or not written as the layout says.
    """
    lines = Lines(pipe, what, layout)
    head = _head(lines, what, layout)
    separator = layout.separator or ","
    check_separator(LABEL, head[1], separator, layout, f"line {head[0]}")
    names = [" ".join(cell.split()) for cell in cells_of(head[1], separator)]
    if layout.header is False:
        lines.back([head])
        names = [f"c{k}" for k in range(1, len(names) + 1)]
    return ComingTable(LABEL, names, lines, separator, layout, what=what, units=_units(lines, names, separator, layout))


def _head(lines: Lines, what: str, layout: Layout) -> tuple[int, str]:
    """The line that names the columns, or of a table without one the first row."""
    while (found := lines.first()) is not None:
        line, text = found
        if layout.header is not True and layout.header is not False and line < layout.header:
            continue
        if text.strip() and not (layout.comment is not None and text.startswith(layout.comment)):
            return line, text
    raise UlnaInputError(f"{LABEL}: it is empty; expected {what}. Write to it, or name a file.")


def _units(lines: Lines, names: Sequence[str], separator: str, layout: Layout) -> dict[str, str]:
    """What the line below the names says of their units, where it says nothing else; it is no reading then."""
    below = lines.first() if layout.header is not False and layout.units_row is not False else None
    if below is None:
        return {}
    cells = [cell.strip().strip("[]()") for cell in cells_of(below[1], separator)] if below[1].strip() else []
    said = [cell for cell in cells if cell]
    if layout.units_row or (said and all(cell.casefold() in UNITS for cell in said)):
        return {name: cell for name, cell in zip(names, cells, strict=False) if cell}
    lines.back([below])
    return {}
