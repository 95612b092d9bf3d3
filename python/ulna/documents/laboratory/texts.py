"""Texts, dates and codes of a laboratory file: checked once, here, so that a certificate can hold them.

A value is checked before its type is, so that the message says what was expected there and not what Python calls it.
"""

from __future__ import annotations

import datetime
import re
from typing import Annotated, Any

from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from ulna.documents.laboratory.iso_codes import COUNTRIES, LANGUAGES, SLIPS

#: what XML 1.0 cannot hold, §2.2 "Characters": controls but tab and line ends, halves of surrogate pairs, two codes
_NO_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

#: a character of an address as it may stand (RFC 3987 without what it reserves), or two digits behind a %
_IN_LINK = r"(?:[^\s\x00-\x20<>\"{}|\\^`\[\]#?%/:@]|%[0-9A-Fa-f]{2})"
_LINK = re.compile(
    rf"https?://{_IN_LINK}+(:[0-9]{{1,5}})?(/(?:{_IN_LINK}|[/:@])*)?(\?(?:{_IN_LINK}|[/?:@])*)?(#(?:{_IN_LINK}|[/?:@])*)?"
)


def unwritable(text: str) -> str | None:
    """The first character that no XML file can hold, as `U+0007`; None where there is none."""
    found = _NO_XML.search(text)
    return None if found is None else f"U+{ord(found[0]):04X}"


def _problem(text: Any, lines: bool) -> str | None:
    """What would have been right, where a text is not."""
    if not isinstance(text, str):
        return "a text in quotes"
    if not text.strip():
        return "a text that is not empty; fill it in, or remove the key where it may be left out"
    if (code := unwritable(text)) is not None:
        return f"a text without the control character {code}, which a certificate cannot hold"
    if text != text.strip():
        return "a text without blanks at its ends"
    if not lines and re.search(r"[\t\n\r]", text):
        return "a text of one line"
    return None


def _line(value: Any) -> Any:
    if (problem := _problem(value, lines=False)) is not None:
        raise PydanticCustomError("line", "{problem}", {"problem": problem})
    return value


def _text(value: Any) -> Any:
    if isinstance(value, dict):
        if not value:
            raise PydanticCustomError("text", "a text for each language, or one text in quotes")
        for language, text in value.items():
            if language not in LANGUAGES:
                raise PydanticCustomError(
                    "text", "a table of language = text; '{key}' is no code of ISO 639-1", {"key": language}
                )
            if (problem := _problem(text, lines=True)) is not None:
                raise PydanticCustomError("text", "in '{key}' {problem}", {"key": language, "problem": problem})
        return value
    if (problem := _problem(value, lines=True)) is not None:
        more = " or a table of language = text" if problem == "a text in quotes" else ""
        raise PydanticCustomError("text", "{problem}", {"problem": problem + more})
    return value


def _date(value: Any) -> Any:
    if type(value) is not datetime.date:  # a date with a time is one too
        raise PydanticCustomError("day", "a date without quotes, such as 2026-03-31")
    return value


def _country(value: Any) -> Any:
    if not isinstance(value, str) or value not in COUNTRIES:
        near = SLIPS.get(value, value.upper()) if isinstance(value, str) else ""
        hint = f" (did you mean '{near}'?)" if near in COUNTRIES else ""
        raise PydanticCustomError(
            "country", "a country of ISO 3166-1 in two capitals, such as 'DE'{hint}", {"hint": hint}
        )
    return value


def _language(value: Any) -> Any:
    if not isinstance(value, str) or value not in LANGUAGES:
        near = value.lower() if isinstance(value, str) else ""
        hint = f" (did you mean '{near}'?)" if near in LANGUAGES else ""
        raise PydanticCustomError(
            "language", "a language of ISO 639-1 in two small letters, such as 'en'{hint}", {"hint": hint}
        )
    return value


def _link(value: Any) -> Any:
    if not isinstance(value, str) or _LINK.fullmatch(value) is None:
        raise PydanticCustomError("link", "an address such as https://laboratory.example/page")
    return value


Line = Annotated[str, BeforeValidator(_line)]
"""One line, not empty."""
Text = Annotated[str | dict[str, str], BeforeValidator(_text)]
"""A text of one or more lines, or one for each language: { en = "…", de = "…" }."""
Day = Annotated[datetime.date, BeforeValidator(_date)]
"""A date."""
Country = Annotated[str, BeforeValidator(_country)]
"""ISO 3166-1 alpha-2."""
Language = Annotated[str, BeforeValidator(_language)]
"""ISO 639-1."""
Link = Annotated[str, BeforeValidator(_link)]
"""http or https."""
