"""Text for the printed page. It reaches Typst as strings in JSON, so that none of it is ever read as markup; what is
done here is only what paper needs: names keep their direction, and words that are too long can be broken."""

from __future__ import annotations

import re
from typing import Any

from ulna.documents.html.markup import END, ISOLATE, number
from ulna.documents.languages.words import Words

#: controls, and what turns or overrides the direction of the text about it; they are shown as U+FFFD, never obeyed
_CONTROLS = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
#: letters in a row before a word may be broken anywhere; scripts that break anywhere by themselves count for nothing
LONGEST = 22
_LONG_WORD = re.compile(rf"[^\s\u200b\u2e80-\u9fff\uf900-\ufaff\uff00-\uffef]{{{LONGEST + 1},}}")
_PIECE = 10


def clean(value: Any) -> str:
    """As it is, but controls are seen and not obeyed, and a long word may be broken (by spaces of no width)."""
    given = _CONTROLS.sub("\ufffd", str(value).replace("\r\n", "\n").replace("\t", " "))
    return _LONG_WORD.sub(lambda found: _pieces(found[0]), given)


def _pieces(word: str) -> str:
    """Better after a sign than in the middle of a word."""
    parts = re.split(r"(?<=[/\\_.:,;-])", word)
    return "\u200b".join(part[k : k + _PIECE] for part in parts for k in range(0, len(part), _PIECE))


def name(value: Any) -> str:
    """A name from a file: its direction is its own, whatever stands about it."""
    return f"{ISOLATE}{clean(value)}{END}"


def plain(value: Any) -> str:
    """What fills a sentence: names isolated, whole numbers as they are, others with four digits."""
    if isinstance(value, float):
        return number(value)
    return str(value) if isinstance(value, int) else name(value)


def words_for_paper(language: str) -> Words:
    """The words of a language; commands stand in quotation marks, as there is no other sign for them in text."""
    quoted = "„\\1“" if language == "de" else "“\\1”"
    return Words(language, lambda given: re.sub("`([^`]+)`", quoted, given), plain)
