"""How the record is kept: whether certificates need four eyes, how they are numbered."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ulna.ground.errors import UlnaInputError
from ulna.records.acts.act import Act, Row
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import SETTING

NAMES = {"four-eyes": "no", "numbers": "{year}-{n:04}"}
"""Each with what holds where nobody said anything."""

_PATTERN = re.compile(r"(?:[^{}]|\{year\}|\{n(?::0?[1-9])?\})+")
"""No other braces: Python's own pads to any width, and reaches into objects."""


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """One."""
    yield SETTING, {"name": entry.subject, "value": entry.stated["value"]}


ACT = Act("setting", "set", rows)


def check(name: str, value: str) -> None:
    """Raises UlnaInputError for a value that means nothing."""
    _CHECKS[name](value)


def _four_eyes(value: str) -> None:
    if value not in ("yes", "no"):
        raise UlnaInputError(f"setting four-eyes: got '{value[:40]}', expected yes or no. Correct it.")


def _numbers(value: str) -> None:
    if not (_PATTERN.fullmatch(value) and "{n" in value and value.isprintable() and len(value) <= 60):
        raise UlnaInputError(
            f"setting numbers: got '{value[:40]}', expected a pattern with {{n}}, such as AB-{{year}}-{{n:04}}. "
            "Correct it."
        )


_CHECKS = {"four-eyes": _four_eyes, "numbers": _numbers}
