"""Text that is not yet on a page: own words, names from files, commands, all in their order and none of it markup.

Each rendering decides what a piece becomes: an element of HTML, a string for Typst, plain text for XML.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from ulna.ground.digits import fixed, small

Style = Literal["english", "aside", "pass", "fail", "undecided", "none"]
"""Of several pieces: English whatever the page's language; beside the point; a verdict."""


@dataclass(frozen=True)
class Name:
    """What a file says: its direction is its own, and nothing of it is markup."""

    text: str


@dataclass(frozen=True)
class Command:
    """What to type."""

    text: str


@dataclass(frozen=True)
class Code:
    """Letters of equal width: a hash, options."""

    text: str


@dataclass(frozen=True)
class Styled:
    """Pieces that are shown in a way of their own."""

    text: Text
    style: Style


Piece = str | Name | Command | Code | Styled
"""Plain strings are our own words, and numbers."""
Text = tuple[Piece, ...]

ISOLATE, END = "\u2068", "\u2069"
"""First-strong isolate of Unicode, for names where there are no elements: right-to-left ones do not turn their
sentence."""

NONE: Text = ("–",)
"""Where there is no value."""


def named(*values: object) -> Text:
    """Names from files, blanks between them."""
    return joined([(Name(str(value)),) for value in values], " ")


def styled(text: Text, style: Style) -> Text:
    """The same, shown in a way of its own."""
    return (Styled(text, style),)


def joined(texts: Iterable[Text], between: str = "") -> Text:
    """One after the other; what is empty is left out, and so is what would stand beside it."""
    found: list[Piece] = []
    for text in texts:
        if text and found and between:
            found.append(between)
        found += text
    return tuple(found)


def number(value: float) -> str:
    """A number in a sentence, four digits."""
    if not math.isfinite(value):
        return "–"
    size = abs(value)
    if value == 0.0 or 1e-3 <= size < 1e6:
        return fixed(value, min(max(3 - math.floor(math.log10(size)), 0), 6)) if size else "0"
    return small(value, 3)


def plain(text: Text) -> str:
    """All of it as one string: for what knows no style, such as an element of XML."""
    return "".join(_plain(piece) for piece in text)


def _plain(piece: Piece) -> str:
    if isinstance(piece, Styled):
        return plain(piece.text)
    return piece if isinstance(piece, str) else piece.text
