"""`ulna-check/1`: what a check found, as JSON; the history of later ones. Lengths mm.

These models write the file and read it.
"""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Any, Literal

from ulna.formats.models import fill
from ulna.formats.spelling import MOST
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError
from ulna.verification.decision import Verdict
from ulna.verification.result_file import (
    ContributorTable,
    EnvironmentTable,
    SourceTable,
    TouchesTable,
    UsedDecision,
    Written,
)

FORMAT: Literal["ulna-check/1"] = "ulna-check/1"
WHAT = f'the result of a check (JSON, format = "{FORMAT}")'


class SignalTable(Written):
    """What is out of control."""

    rule: str
    words: str
    slow: bool
    """Whether several checks together show it."""


class HistoryTable(Written):
    """What the history of a figure says of it; null where there are too few earlier checks."""

    method: str
    n: int
    """Checks of the baseline."""
    fewest: int
    span_days: float | None
    """Of the baseline."""
    said: str
    """In words: of how many, or that they are too few."""
    earlier: int
    """Earlier checks that have the figure, the baseline's and those after it."""
    not_used: int
    """And those in which it was out by itself."""
    centre: float | None
    lower: float | None
    """Of a single figure; null also of one that cannot be negative."""
    upper: float | None
    average: float | None
    average_lower: float | None
    average_upper: float | None
    in_control: bool | None
    signals: list[SignalTable]
    notes: list[str]
    """In words: figures in a row that the protocol does not count."""


class CheckedTable(Written):
    """A figure of one place."""

    test: str
    kind: str
    """Of the test."""
    key: str
    """The figure's short name."""
    name: str
    formula: str
    standard: str
    signed: bool
    """Whether it may be negative."""
    of: dict[str, str]
    """Labels of the measurement: artefact, position, orientation, repeat."""
    unit: Literal["mm"]
    value: float
    calibrated: float | None
    measured: float | None
    limit: float | None
    u: float | None
    """Standard uncertainty of the value."""
    expanded: float | None
    """U = k u"""
    guard: float | None
    verdict: Verdict | None
    why: str | None
    """Why there is no verdict."""
    budget: list[ContributorTable]
    left_out: list[str]
    """What the uncertainty does not hold."""
    history: HistoryTable | None
    """null where no history was named."""


class AdviceTable(Written):
    """What to try where figures of a test are out."""

    test: str
    figures: list[str]
    """Which, with their labels."""
    why: list[str]
    steps: list[str]
    """In the order of what it costs."""


class UsedProtocol(Written):
    """Which protocol."""

    name: str
    path: str
    sha256: str


class EarlierTable(Written):
    """An earlier check that figures were judged by."""

    path: str
    sha256: str
    time: str


class CheckProvenance(Written):
    """From what and with what figures were made."""

    program: str
    version: str
    arms: list[SourceTable]
    """The arm file that made points of encoder readings."""
    files: list[TouchesTable]
    history: list[EarlierTable]
    """In order of time."""
    warnings: list[str]
    time: str
    """When it was evaluated, ISO 8601."""


class CheckFile(Written):
    """What a check found: `ulna-check/1`."""

    format: Literal["ulna-check/1"]
    protocol: UsedProtocol
    arm: str
    time: str
    """When it was measured, ISO 8601."""
    operator: str | None
    verdict: Verdict | None
    """The worst of all limits; null where none was stated."""
    in_control: bool | None
    """Whether all figures with a history of enough checks are; null where none has one."""
    decision: UsedDecision
    environment: EnvironmentTable
    artefacts: list[dict[str, Any]]
    """name, then the keys of the protocol's table of it."""
    figures: list[CheckedTable]
    departures: list[str]
    """In words: where what was measured is not what the protocol counts."""
    advice: list[AdviceTable]
    provenance: CheckProvenance


def load_check(path: Path) -> tuple[CheckFile, datetime, str]:
    """A check, when it was measured, and the file's SHA-256. Raises UlnaInputError."""
    document, digest = read_json(path, WHAT)
    check_format(document, path, "ulna-check")
    found = fill(CheckFile, document, path)
    for number, figure in enumerate(found.figures, start=1):
        if abs(figure.value) > MOST:
            raise UlnaInputError(
                f"{path}: key 'figures.{number}.value': got {figure.value:g}, more than any length is; expected mm, as "
                "ulna check wrote it. The file was changed or damaged: check again."
            )
    return found, time_of(found.time, f"{path}: key 'time'"), digest


def time_of(text: str, where: str) -> datetime:
    """A date, or date and time, ISO 8601; without a zone that of this machine. Raises UlnaInputError."""
    try:
        return datetime.fromisoformat(text).astimezone()
    except (ValueError, OverflowError, OSError):
        raise UlnaInputError(
            f"{where}: got '{text[:40]}', expected a date, or date and time, such as 2026-11-30 or "
            "2026-11-30T07:45+01:00. Correct it."
        ) from None
