"""How the record is kept: whether certificates need four eyes, how they are numbered."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.ground.errors import UlnaInputError
from ulna.records.acts.act import Act, Row
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import SETTING

NAMES = {"four-eyes": "no", "numbers": "{year}-{n:04}"}
"""Each with what holds where nobody said anything."""


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
    try:
        one, other = (value.format(year=2026, n=n) for n in (1, 2))
    except (ValueError, KeyError, IndexError, AttributeError):
        one = other = ""
    if one == other or not one.isprintable() or len(one) > 60:
        raise UlnaInputError(
            f"setting numbers: got '{value[:40]}', expected a pattern with {{n}}, such as AB-{{year}}-{{n:04}}. "
            "Correct it."
        )


_CHECKS = {"four-eyes": _four_eyes, "numbers": _numbers}
