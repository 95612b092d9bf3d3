"""The columns of a table that is not yet understood, as they are: what stands above them, what stands in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import polars as pl

from ulna.formats.header import Header
from ulna.proposals.words import Meaning, meaning
from ulna.study.data import Taken as Taken

#: a column holds numbers where at least this share of its filled cells does
_NUMBERS = 0.8


@dataclass(frozen=True)
class Column:
    """One column."""

    name: str
    """The file's."""
    texts: pl.Series
    """(N,) without spaces around; "" where empty."""
    numbers: pl.Series
    """(N,) null where a cell is no number."""
    meaning: Meaning

    @property
    def filled(self) -> int:
        """Cells that hold something."""
        return int((self.texts != "").sum())

    @property
    def numeric(self) -> bool:
        """Whether it holds numbers, but for some bad cells."""
        return self.filled > 0 and int(self.numbers.is_not_null().sum()) >= _NUMBERS * self.filled

    @property
    def labels(self) -> list[str]:
        """What stands in its cells, each once, in the order in which they come."""
        return [text for text in self.texts.unique(maintain_order=True).to_list() if text]

    @property
    def bad(self) -> list[int]:
        """Rows, from 1, in which there is no number."""
        strange = self.numbers.is_null() | self.numbers.is_nan() | self.numbers.is_infinite()
        return [row + 1 for row in strange.arg_true().to_list()]

    def down(self) -> pl.Series:
        """The texts with empty cells filled from above."""
        return self.texts.replace("", None).forward_fill().fill_null("")


def columns_of(header: Header) -> list[Column]:
    """All columns of a table. Raises UlnaInputError for a file that is damaged."""
    texts = header.cells(lambda _: False, header.columns)
    texts = texts.with_columns(pl.all().fill_null("").str.strip_chars())
    found = []
    for name in header.columns:
        said = meaning(name)
        if not said.unit and header.units.get(name):
            said = Meaning(said.role, said.number, header.units[name].casefold(), said.word, said.goal)
        found.append(Column(name, texts[name], header.numbers(texts[name]), said))
    return found


def named(columns: Sequence[Column], name: str) -> Column | None:
    """The column of a name."""
    return next((column for column in columns if column.name == name), None)


def own_rows(columns: Sequence[Column], of_rows: tuple[str, str] | None) -> Sequence[Column]:
    """The columns without that which names artefacts, and only the rows in which it says the label; all where nobody
    asks for some."""
    if of_rows is None:
        return columns
    name, label = of_rows
    own = next(column for column in columns if column.name == name).down() == label
    rest = [column for column in columns if column.name != name]
    return [replace(c, texts=c.texts.filter(own), numbers=c.numbers.filter(own)) for c in rest]
