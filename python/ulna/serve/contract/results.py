"""What a calibration found: the sections of its report as data, in the language asked for, and its readings."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Said, Sentence, Sha256, Value


class Piece(Said):
    """Part of a text: our own words, a name from a file, something to type, letters of equal width, or a verdict."""

    style: Literal["plain", "name", "command", "code", "english", "aside", "pass", "fail", "undecided", "none"]
    text: str


Text = list[Piece]
Tone = Literal["plain", "note", "missing", "good", "bad"]


class HeadingBlock(Said):
    """Of a part of a section."""

    block: Literal["heading"] = "heading"
    text: Text


class ParagraphBlock(Said):
    """One or more sentences."""

    block: Literal["paragraph"] = "paragraph"
    text: Text
    tone: Tone


class ListedBlock(Said):
    """Points."""

    block: Literal["listed"] = "listed"
    items: list[Text]


class Fact(Said):
    """Something and its values."""

    key: str
    what: Text
    lines: list[Text]


class FactsBlock(Said):
    """Facts, one below the other."""

    block: Literal["facts"] = "facts"
    rows: list[Fact]


class TableBlock(Said):
    """Cells under heads."""

    block: Literal["table"] = "table"
    name: str
    label: Text
    columns: list[str]
    heads: list[Text]
    rows: list[list[Text]]
    left: int
    """So many columns hold words, the others numbers."""


class Tile(Said):
    """A key figure, what it is, and what it was."""

    value: Text
    label: Text
    more: Text


class TilesBlock(Said):
    """Key figures side by side."""

    block: Literal["tiles"] = "tiles"
    tiles: list[Tile]


class DrawingsBlock(Said):
    """Plots, which the report of the same result shows: their captions."""

    block: Literal["drawings"] = "drawings"
    captions: list[Text]


Block = Annotated[
    HeadingBlock | ParagraphBlock | ListedBlock | FactsBlock | TableBlock | TilesBlock | DrawingsBlock,
    Field(discriminator="block"),
]


class Section(Said):
    """One section of a report."""

    key: str
    title: str
    blocks: list[Block]


class Residual(Said):
    """One reading that was fitted, and what the fit leaves of it."""

    row: int
    """Of its file, from 1; of a session, in the order of its touches."""
    artefact: str
    place: str
    feature: str
    off: Value
    times_scatter: float | None
    """How far off, in units of the scatter of its artefact's readings."""
    outlier: bool


class ResultWhole(Said):
    """One result."""

    sha256: Sha256
    arm: str
    converged: bool
    ending: Sentence
    sections: list[Section]
    residuals: list[Residual]
    """The farthest off first, 200 at most."""
