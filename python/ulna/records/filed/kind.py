"""What a kind of file owes the record."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ulna.ground.errors import UlnaInputError
from ulna.records.acts.act import Row
from ulna.records.tables import FIGURE

_DAY = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}")
GOOD, BAD, OUT = "pass", "fail", "out of control"
"""Verdicts of figures; the last is of the history of a check."""


@dataclass(frozen=True)
class About:
    """What was said of a file when it was filed."""

    arm: str
    sha256: str
    at: str
    """When it was made or measured, ISO 8601, UTC."""


@dataclass(frozen=True)
class Read:
    """A file that was read as every command reads it."""

    arm: str | None
    """The name of the arm in it."""
    at: str | None
    """When it was made, as it says."""
    beside: Mapping[str, Path]
    """Files that it cannot be read without: their name → where they are."""


class FiledKind(ABC):
    """A kind of file."""

    name: str
    """As lists and the chain have it."""
    format: str | None
    """How its `format` begins; None of files of no format of ours."""

    @abstractmethod
    def read(self, path: Path) -> Read:
        """As every command reads it. Raises UlnaInputError for a file that cannot be used."""

    @abstractmethod
    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """What follows from it, of content that `read` found good."""


def figure(about: About, source: str, state: str, name: str, value: float, **more: Any) -> Row:
    """A row of the table that all charts read; `more`: artefact, u, k, limit_value, verdict, unit (else mm)."""
    return FIGURE, {
        "arm": about.arm,
        "sha256": about.sha256,
        "source": source,
        "at": about.at,
        "state": state,
        "name": name,
        "value": value,
        "unit": "mm",
        **more,
    }


def figures_mm(about: About, source: str, state: str, figures: Mapping[str, Any]) -> Iterator[Row]:
    """Of figures as results name them; those that the readings do not give are left out."""
    for name, value in figures.items():
        if isinstance(value, float | int):
            yield figure(about, source, state, name, float(value))


def in_utc(said: str, what: str) -> str:
    """A time as the record has it: ISO 8601 in UTC, to the microsecond, so that every database puts them in one order;
    one without a zone is this machine's, a day alone is its noon in UTC on every machine.

    Raises UlnaInputError for what is no time.
    """
    try:
        # Python takes 20260101 and 2026-W01-1 as well, which would be a midnight of this machine
        if not _DAY.match(said):
            raise ValueError
        day = _DAY.fullmatch(said) is not None
        time = datetime.fromisoformat(said)
        return (time.replace(hour=12, tzinfo=UTC) if day else time.astimezone(UTC)).isoformat(timespec="microseconds")
    except (ValueError, OverflowError, OSError):
        raise UlnaInputError(
            f"{what}: got '{said[:40]}', expected a day or a time such as 2026-11-30 or 2026-11-30T14:05. Correct it."
        ) from None
