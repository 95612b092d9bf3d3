"""What a section is made of. No markup, no widths, no colours: each rendering has its own for each kind of block.

Columns and facts have keys, so that a medium with less room can leave some out; which rows there are, what is in a cell
and how it is rounded is the section's.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words

Tone = Literal["plain", "note", "missing", "good", "bad"]
"""note: beside the point; missing: something is not known; good, bad: how it ended."""


@dataclass(frozen=True)
class Heading:
    """Of a part of a section."""

    text: Text


@dataclass(frozen=True)
class Paragraph:
    """One or more sentences."""

    text: Text
    tone: Tone = "plain"


@dataclass(frozen=True)
class Listed:
    """Points."""

    items: Sequence[Text]


@dataclass(frozen=True)
class Fact:
    """Something and its values."""

    key: str
    what: Text
    lines: Sequence[Text]


@dataclass(frozen=True)
class Facts:
    """Facts, one below the other."""

    rows: Sequence[Fact]

    def without(self, keys: Collection[str]) -> Facts:
        """Where they stand elsewhere in the document."""
        return Facts([row for row in self.rows if row.key not in keys])


@dataclass(frozen=True)
class Table:
    """Cells under heads."""

    name: str
    """By which a rendering knows how wide its columns are."""
    label: Text
    """What a screen reader says of it."""
    columns: Sequence[str]
    """Keys, one for each cell of a row."""
    heads: Sequence[Text]
    rows: Sequence[Sequence[Text]]
    left: int
    """So many columns hold words, the others numbers."""

    def only(self, keys: Collection[str]) -> Table:
        """With these columns alone, in their order here. Errors: KeyError for a column that there never is."""
        kept = [k for k, key in enumerate(self.columns) if key in keys]
        return Table(
            self.name,
            self.label,
            [self.columns[k] for k in kept],
            [self.heads[k] for k in kept],
            [[row[k] for k in kept] for row in self.rows],
            sum(k < self.left for k in kept),
        )


@dataclass(frozen=True)
class Tile:
    """A key figure, what it is, and what it was."""

    value: Text
    label: Text
    more: Text = ()


@dataclass(frozen=True)
class Tiles:
    """Key figures side by side."""

    tiles: Sequence[Tile]


@dataclass(frozen=True)
class Drawing:
    """A plot, which each medium draws in its own way, and adds to the caption what it shows of many points."""

    kind: str
    """"histogram", "cloud", …: by which a medium knows how to draw it."""
    name: str
    """Unique in the document, letters and hyphens."""
    of: Any
    """What is drawn."""
    caption: Text = ()
    heading: Text = ()


@dataclass(frozen=True)
class Drawings:
    """Plots; `narrow` ones stand side by side."""

    drawings: Sequence[Drawing]
    narrow: bool = False


Block = Heading | Paragraph | Listed | Facts | Table | Tiles | Drawings


def table(
    name: str, label: Text, words: Words, columns: Sequence[str], rows: Iterable[Sequence[Text]], left: int
) -> Table:
    """A table whose heads are the words `column.KEY`."""
    return Table(name, label, columns, [words(f"column.{key}") for key in columns], list(rows), left)


def own(*parts: object) -> Text:
    """Our own words or numbers, already written."""
    return tuple(str(part) for part in parts)


def paragraphs(texts: Iterable[Text], tone: Tone = "plain") -> list[Block]:
    """Each for itself."""
    return [Paragraph(text, tone) for text in texts]
