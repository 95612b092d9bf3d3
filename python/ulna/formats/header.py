"""The head of a table: what is known before its rows are read, and how they are read. One subclass per format, below
`tables/`, so that nobody else asks what kind of file it is.

Rows are data rows counted from 1, the header not counted. Columns have the names that the rest of Ulna uses: its own
where the study maps them, else the file's.
"""

from __future__ import annotations

import dataclasses
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

import numpy as np
import polars as pl

from ulna.formats.places import Places
from ulna.formats.spelling import MOST
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError

MOST_CELLS = 20
"""Bad cells that one message names."""
#: what to do, in messages about a cell: said once where there are several
_USUAL = re.compile(r"(?<=[.]) (Correct it|Fill it)[^.]*[.]$")
_EXPECTED = re.compile(r"(?=[,;] expected )")

#: true for the name of a column that holds numbers
Numeric = Callable[[str], bool]


@dataclass(frozen=True)
class Piece:
    """Some consecutive data rows of a table."""

    before: int
    """Number of data rows before the first of these."""
    numbers: F64
    """(N, k), of `MOST` at most in size, C order."""
    texts: dict[str, pl.Series]
    """(N,) each, no empty cell."""

    def __len__(self) -> int:
        return len(self.numbers)


@dataclass(frozen=True)
class Header(ABC):
    """A table whose columns are known and whose rows are not yet read."""

    path: Path
    columns: list[str]
    theirs: Mapping[str, str] = field(default_factory=dict, kw_only=True)
    """The file's own name of each column that the study calls otherwise."""
    what: str = field(default="a table", kw_only=True)
    """What is expected of the file, in words."""
    remarks: list[str] = field(default_factory=list, kw_only=True)
    """What was passed over or recognised when the file was opened: whoever reads it says so."""
    labels: Mapping[str, Mapping[str, str]] = field(default_factory=dict, kw_only=True)
    """Of columns whose cells the study calls otherwise: the file's label → Ulna's name."""
    units: Mapping[str, str] = field(default_factory=dict, kw_only=True)
    """What the file itself says of its columns' units, as it is written there: the file's name → "deg"."""

    @property
    def head(self) -> str:
        """How a message calls the place where the columns' names stand: "line 1" of a CSV file."""
        return "the header"

    @property
    def rows(self) -> int | None:
        """Number of data rows; None where nobody knows without reading them."""
        return None

    def counted(self) -> int | None:
        """The same, found by looking through the file once where that is quick; None where it cannot be known before
        all is read: what comes from a pipe, what is damaged."""
        return self.rows

    def own(self, column: str) -> str:
        """The file's own name of a column."""
        return self.theirs.get(column, column)

    def origin(self, column: str) -> str:
        """Of what a column was made, where that may surprise: "'q' is 7 × 500"; else ""."""
        return ""

    @property
    def further(self) -> str:
        """Where more of the file is, which was not read, as a sentence with a blank before it; else ""."""
        return ""

    def find(self, name: str) -> str | None:
        """The column that is meant by the file's own name or by Ulna's; the file's own names go first."""
        own = [column for column in self.columns if self.own(column) == name]
        return own[0] if own else name if name in self.columns else None

    def renamed(self, names: Mapping[str, str]) -> Self:
        """The same table with its columns called anew: the file's name → Ulna's name."""
        columns = [names.get(column, column) for column in self.columns]
        return dataclasses.replace(self, columns=columns, theirs={new: old for old, new in names.items()})

    def named(self, column: str) -> str:
        """How a message calls a column: `column 'q1'`, or `column 'shoulder' (q1)` where the study maps it."""
        own = self.own(column)
        return f"column '{own}'" + (f" ({column})" if own != column else "")

    def where(self, row: int) -> str:
        """How a message calls a data row: with its line where the file has lines."""
        return f"row {row}"

    def at(self, row: int, column: str) -> str:
        """How a message calls a cell."""
        return f"{self.where(row)}, {self.named(column)}"

    @property
    def row_places(self) -> Places | None:
        """Where data rows stand in the file, as its own program calls them: "line 7", `Messung!A12`; None where rows
        have no other name than their number."""
        return None

    @abstractmethod
    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        """All rows of some columns: Float64 where `numeric` says so, else String. A gap (or NaN, infinity) where a
        cell is empty or not of that kind; that is no error yet. Raises UlnaInputError for a file that is damaged."""

    def numbers(self, texts: pl.Series) -> pl.Series:
        """Cells that were read as String, as Float64; a gap where a cell is no number."""
        return texts.cast(pl.Float64, strict=False)

    @abstractmethod
    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        """The message about a cell that `cells` left as a gap, that is not finite, or beyond `MOST`."""

    def frame(self, numeric: Numeric, columns: Sequence[str], blank: Sequence[str] = ()) -> pl.DataFrame:
        """All rows of some columns, every cell filled but those of `blank`, every number finite and of a size that
        quantities have. Raises UlnaInputError naming row, column and value of the cells that are not."""
        return self.checked(self.cells(numeric, columns), numeric, blank=blank)

    def pieces(self, numbers: Sequence[str], texts: Sequence[str], rows: int) -> Iterator[Piece]:
        """The same in pieces of about `rows` rows, in bounded memory where the format allows it. Here it does not."""
        frame = self.frame(lambda column: column in numbers, [*numbers, *texts])
        for before in range(0, len(frame), rows):
            yield self.piece(frame.slice(before, rows), numbers, texts, before)

    def piece(self, frame: pl.DataFrame, numbers: Sequence[str], texts: Sequence[str], before: int) -> Piece:
        """Checked rows as arrays."""
        values = np.ascontiguousarray(frame.select(numbers).to_numpy(), dtype=np.float64)
        return Piece(before, values, {name: frame[name] for name in texts})

    def checked(
        self,
        frame: pl.DataFrame,
        numeric: Numeric,
        row: I64 | None = None,
        before: int = 0,
        blank: Sequence[str] = (),
    ) -> pl.DataFrame:
        """The frame, if every cell is filled and every number finite and `MOST` at most in size; strings without spaces
        around them.

        row: (N,) the rows' numbers in the file; without it they follow each other after the first `before`. blank:
        columns of names in which cells may be empty (""). Labels are those that the study gives them. Raises
        UlnaInputError naming all bad cells.
        """
        frame = frame.with_columns(pl.col(name).fill_null("") for name in blank if name in frame.columns)
        spaced = [c.name for c in frame if c.dtype == pl.String and bool(c.str.contains(r"^\s|\s$").any())]
        frame = frame.with_columns(pl.col(spaced).str.strip_chars()) if spaced else frame
        said = [name for name in self.labels if name in frame.columns]
        frame = frame.with_columns(pl.col(name).replace(self.labels[name]) for name in said) if said else frame
        found: list[tuple[int, int, str]] = []
        count = 0
        for k, column in enumerate(frame):
            if column.name in blank:
                continue
            good = column.is_between(-MOST, MOST) if numeric(column.name) else column != ""  # NaN is not between
            bad = ~good.fill_null(False)
            if bad.any():
                count += int(bad.sum())
                found += [(int(index), k, column.name) for index in bad.arg_true()[:MOST_CELLS]]
        if not found:
            return frame
        told = [
            self.refusal(before + index + 1 if row is None else int(row[index]), name, numeric)
            for index, _, name in sorted(found)[:MOST_CELLS]
        ]
        raise refused(self, told, count)


def refused(header: Header, told: Sequence[str], count: int) -> UlnaInputError:
    """The error of the messages about the first of `count` bad cells: one by what it is, several in one list."""
    if count == 1:
        return UlnaInputError(told[0])
    start = f"{header.path}: "
    first, *others = [each.removeprefix(start) for each in told]
    tail = _EXPECTED.split(first, maxsplit=1)[-1]
    shortly = [
        _EXPECTED.split(each, maxsplit=1)[0] if each.endswith(tail) else _USUAL.sub("", each).rstrip(".")
        for each in others
    ]
    more = f"; and {count - len(told)} more" if count > len(told) else ""
    return UlnaInputError(f"{start}{first} There are {count} such places: also {'; '.join(shortly)}{more}.")
