"""The words of all documents, from one catalogue. Terms are those of the VIM and its German and Chinese editions.

Numbers have a decimal point in every language, so that they can be copied into files; each report says so.
"""

from __future__ import annotations

import re
import string
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from ulna.documents.languages.languages import language_of
from ulna.documents.languages.said import Said
from ulna.documents.languages.text import Command, Name, Piece, Text, number


@cache
def dictionary(language: str) -> Mapping[str, str]:
    """Key → text of a language. `{name}` stands for a value. Raises UlnaInputError for an unknown language."""
    file = resources.files("ulna.documents.languages") / f"{language_of(language).code}.toml"
    words: dict[str, str] = tomllib.loads(file.read_text(encoding="utf-8").replace("\r\n", "\n"))
    return words


@dataclass(frozen=True)
class Words:
    """The words of one language."""

    language: str
    """A code of `ulna.documents.languages.languages.LANGUAGES`."""

    def __call__(self, key: str, /, **values: Any) -> Text:
        """The text of a key, `values` put in: texts as they are, strings as names from files, whole numbers as they
        are, others with four digits. Errors: KeyError for a key that the catalogue has not, or a value that lacks."""
        found: list[Piece] = []
        for own, field in _parts(self.language, key):
            found += own
            if field is not None:
                found += _shown(values[field])
        return tuple(found)

    def say(self, said: Said) -> Text:
        """A statement of the content."""
        return self(said.key, **said.values)

    def has(self, key: str) -> bool:
        """Whether there is such a key: of words that files bring (a cause, a verdict) some may be new."""
        return key in dictionary(self.language)


@cache
def _parts(language: str, key: str) -> tuple[tuple[Text, str | None], ...]:
    """Own words and the name of the value behind them, in their order."""
    parsed = string.Formatter().parse(dictionary(language)[key])
    return tuple((_commands(own), field) for own, field, _, _ in parsed)


def _commands(own: str) -> Text:
    """Our own words, `commands` apart."""
    pieces = re.split("`([^`]+)`", own)
    return tuple(Command(each) if k % 2 else each for k, each in enumerate(pieces) if each)


def _shown(value: Any) -> Text:
    if isinstance(value, tuple):
        return value
    if isinstance(value, float):
        return (number(value),)
    return (str(value),) if isinstance(value, int) else (Name(str(value)),)
