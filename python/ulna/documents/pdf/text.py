"""Text for the printed page. It reaches Typst as strings in JSON, so that none of it is ever read as markup; what is
done here is only what paper needs: names keep their direction, and words that are too long can be broken."""

from __future__ import annotations

import re
from typing import Any

from ulna.documents.languages.languages import language_of
from ulna.documents.languages.text import END, ISOLATE, Code, Command, Name, Style, Styled, Text

#: controls, and what turns or overrides the direction of the text about it; they are shown as U+FFFD, never obeyed
_CONTROLS = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
#: letters in a row before a word may be broken anywhere; scripts that break anywhere by themselves count for nothing
LONGEST = 22
_LONG_WORD = re.compile(rf"[^\s\u200b\u2e80-\u9fff\uf900-\ufaff\uff00-\uffef]{{{LONGEST + 1},}}")
_PIECE = 10

#: a number with decimals in our own words; versions and numbers of clauses have more points, or belong to a name
_DECIMALS = re.compile(r"(?<![\d.])(\d+)\.(\d+)(?![\d]*\.\d)")

Piece = str | dict[str, str]
"""A string, or one with a style: {text, style: "code" or "english"}."""
Cell = str | list[Piece]

#: style → what the template calls it; None: paper shows it like any text
_STYLES: dict[Style, str | None] = {
    "english": "english",
    "aside": None,
    "pass": None,
    "fail": None,
    "undecided": None,
    "none": None,
}


def clean(value: Any) -> str:
    """As it is, but controls are seen and not obeyed, and a long word may be broken (by spaces of no width)."""
    given = _CONTROLS.sub("\ufffd", str(value).replace("\r\n", "\n").replace("\t", " "))
    return _LONG_WORD.sub(lambda found: _pieces(found[0]), given)


def _pieces(word: str) -> str:
    """Better after a sign than in the middle of a word."""
    parts = re.split(r"(?<=[/\\_.:,;-])", word)
    return "\u200b".join(part[k : k + _PIECE] for part in parts for k in range(0, len(part), _PIECE))


def name(value: Any) -> str:
    """A name from a file: cleaned, its direction its own."""
    return f"{ISOLATE}{clean(value)}{END}"


def line(text: Text, language: str) -> str:
    """All of it as one string; commands stand in quotation marks, as there is no other sign for them."""
    return "".join(piece if isinstance(piece, str) else piece["text"] for piece in _set(text, language, None))


def cell(text: Text, language: str) -> Cell:
    """A string where nothing of it has a style, else its pieces."""
    pieces = _set(text, language, None)
    if all(isinstance(piece, str) for piece in pieces):
        return line(text, language)
    return pieces


def _set(text: Text, language: str, style: str | None) -> list[Piece]:
    found: list[Piece] = []
    for piece in text:
        if isinstance(piece, Styled):
            found += _set(piece.text, language, _STYLES[piece.style] or style)
        elif isinstance(piece, Code):
            found.append({"text": piece.text, "style": "code"})
        else:
            shown = _shown(piece, language)
            found.append(shown if style is None else {"text": shown, "style": style})
    return found


def decimals(text: str, language: str) -> str:
    """Our own words with the decimal mark of the language."""
    return _DECIMALS.sub(r"\1,\2", text) if language_of(language).comma else text


def _shown(piece: str | Name | Command, language: str) -> str:
    if isinstance(piece, str):
        return decimals(piece, language)
    if isinstance(piece, Name):
        return name(piece.text)
    before, after = language_of(language).quotes
    return f"{before}{piece.text}{after}"
