"""The paper that certificates are written on: elements of DCC and D-SI, texts in the certificate's languages.

Texts go through here, so that what XML cannot hold is told in one message and nothing is ever markup.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from lxml import etree

from ulna.documents.laboratory.texts import unwritable
from ulna.documents.languages.languages import LANGUAGES
from ulna.documents.languages.text import Text, plain
from ulna.documents.languages.words import Words
from ulna.ground.errors import UlnaInputError

DCC = "https://ptb.de/dcc"
SI = "https://ptb.de/si"
NAMES = {"dcc": DCC, "si": SI}

Element: TypeAlias = Any
"""An element of lxml, which ships no types."""
Texts = list[tuple[str | None, str]]
"""A text: (language or None where it names none, text) of each language."""


@dataclass(frozen=True)
class Sheet:
    """How texts are written, and whom to tell of one that cannot be."""

    languages: tuple[str, ...]
    """ISO 639-1, the main one first."""
    source: str
    """The file whose texts are written."""

    def dcc(self, parent: Element, tag: str, text: str | None = None, ref: str | None = None) -> Element:
        """A new last child of the DCC namespace; ref: its refType."""
        element = etree.SubElement(parent, f"{{{DCC}}}{tag}")
        if ref is not None:
            element.set("refType", ref)
        if text is not None:
            element.text = self.held(text)
        return element

    def si(self, parent: Element, tag: str, text: str | None = None) -> Element:
        """A new last child of the D-SI namespace."""
        element = etree.SubElement(parent, f"{{{SI}}}{tag}")
        if text is not None:
            element.text = self.held(text)
        return element

    def held(self, text: str) -> str:
        """The text, where XML can hold it. Raises UlnaInputError."""
        code = unwritable(text)
        if code is not None:
            raise UlnaInputError(
                f"{self.source}: the text {text[:60]!r} holds the control character {code}, which no XML file can "
                "hold; expected text without control characters. Correct it in the file that it comes from."
            )
        return text

    def own(self, key: str, **values: object) -> Texts:
        """One text of the catalogue, see `spoken`. A value may be such texts itself."""
        return self.spoken(lambda words, language: words(key, **_in(language, values)))

    def spoken(self, say: Callable[[Words, str | None], Text]) -> Texts:
        """What Ulna says, in every language of the certificate where Ulna speaks them all, else in English without a
        mark of language: a certificate may not mark some of its languages and leave out others."""
        if set(self.languages) <= set(LANGUAGES):
            return [(language, plain(say(Words(language), language))) for language in self.languages]
        return [(None, plain(say(Words("en"), None)))]

    def theirs(self, text: str | dict[str, str]) -> Texts:
        """A text of the laboratory file. A string belongs to all languages, so where there are several it is not
        marked."""
        if isinstance(text, dict):
            return [(language, text[language]) for language in self.languages]
        return [(self.languages[0] if len(self.languages) == 1 else None, text)]

    def text(self, parent: Element, tag: str, said: Texts, ref: str | None = None) -> Element:
        """An element with one `content` for each language: dcc:textType or dcc:richContentType."""
        element = self.dcc(parent, tag, ref=ref)
        for language, each in said:
            content = self.dcc(element, "content", each)
            if language is not None:
                content.set("lang", language)
        return element


def _in(language: str | None, values: dict[str, object]) -> dict[str, object]:
    """Values that are texts of several languages, in this one."""
    return {name: dict(value)[language] if isinstance(value, list) else value for name, value in values.items()}
