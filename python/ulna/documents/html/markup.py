"""HTML out of text that nobody may trust: everything is escaped here (by markupsafe), and nowhere else."""

from __future__ import annotations

import base64
import hashlib
import html
import json
from collections.abc import Callable
from typing import Any

from markupsafe import Markup, escape

from ulna.documents.languages.text import END, ISOLATE, Code, Command, Name, Piece, Style, Styled, Text
from ulna.documents.languages.words import Words

#: how pieces are shown; a name has its direction for itself
_NAME = Markup('<bdi dir="auto">{}</bdi>')
_CODE = Markup("<code>{}</code>")
_STYLES: dict[Style, Markup] = {
    "english": Markup('<span lang="en">{}</span>'),
    "aside": Markup("<small>{}</small>"),
    "pass": Markup('<b class="verdict pass">{}</b>'),
    "fail": Markup('<b class="verdict fail">{}</b>'),
    "undecided": Markup('<b class="verdict undecided">{}</b>'),
    "none": Markup('<b class="verdict">{}</b>'),
}


def inline(text: Text) -> Markup:
    """Within an element."""
    return Markup("").join(_piece(piece) for piece in text)


def _piece(piece: Piece) -> Markup:
    if isinstance(piece, str):
        return escape(piece)
    if isinstance(piece, Styled):
        return _STYLES[piece.style].format(inline(piece.text))
    return _ELEMENTS[type(piece)].format(piece.text)


_ELEMENTS: dict[type[Name | Command | Code], Markup] = {Name: _NAME, Command: _CODE, Code: _CODE}


def label(text: Text) -> str:
    """For the text of a plot, which knows no elements of HTML but its entities."""
    return "".join(_in_plot(piece) for piece in text)


def _in_plot(piece: Piece) -> str:
    if isinstance(piece, Styled):
        return label(piece.text)
    if isinstance(piece, Name):
        return f"{ISOLATE}{html.escape(piece.text, quote=False)}{END}"
    return html.escape(piece if isinstance(piece, str) else piece.text, quote=False)


def labels(words: Words) -> Callable[..., str]:
    """Words for titles of axes and legends."""
    return lambda key, **values: label(words(key, **values))


def json_in_script(value: Any) -> str:
    """JSON that ends no script element, opens no comment and breaks no line of JavaScript."""
    found = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    return found


def digest(script: str) -> str:
    """As a Content-Security-Policy knows a script: base64 of its SHA-256."""
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
