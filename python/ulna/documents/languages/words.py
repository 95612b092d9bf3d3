"""The words of reports: English, German, Chinese. Terms are those of the VIM and its German and Chinese editions.

Numbers have a decimal point in every language, so that they can be copied into files; each report says so.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from ulna.documents.content import Said

LANGUAGES = ("en", "de", "zh")
"""Codes after ISO 639-1; the words of each are in a TOML file beside this one."""


@cache
def dictionary(language: str) -> Mapping[str, str]:
    """Key → text of a language. `{name}` stands for a value."""
    words: dict[str, str] = tomllib.loads(
        (resources.files("ulna.documents.languages") / f"{language}.toml")
        .read_text(encoding="utf-8")
        .replace("\r\n", "\n")
    )
    return words


class Ready(str):
    """Text of the output's own: words that were filled and escaped already."""


@dataclass(frozen=True)
class Words:
    """The words of one language, for one kind of output."""

    language: str
    """One of `LANGUAGES`."""
    escape: Callable[[str], str] = str
    """What the output needs done to text before it stands there."""
    value: Callable[[Any], str] = str
    """How a value that fills a sentence is shown: escaped already."""

    def __call__(self, key: str, /, **values: Any) -> Ready:
        """The text of a key, `values` put in. Errors: KeyError for a key that no language has."""
        shown = {name: given if isinstance(given, Ready) else self.value(given) for name, given in values.items()}
        return Ready(self.escape(dictionary(self.language)[key]).format_map(shown))

    def say(self, said: Said) -> Ready:
        """A statement of the content."""
        return self(said.key, **said.values)

    def has(self, key: str) -> bool:
        """Whether there is such a key: of words that files bring (a cause, a verdict) some may be new."""
        return key in dictionary(self.language)
