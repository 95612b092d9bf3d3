"""The first screen: arms of the record with how they stand, sessions that go on, and a virtual arm to play with."""

from __future__ import annotations

from ulna.serve.contract.activities import Unfinished
from ulna.serve.contract.model import Name, Said, Sha256


class Card(Said):
    """One arm of the record."""

    name: Name
    kind: str
    maker: str | None
    model: str | None
    serial: str | None
    state: str
    """in use, quarantined, retired."""
    calibration: Sha256 | None
    """The newest that counts; on the desk by this hash."""
    calibrated_at: str | None
    calibrated_days: int | None
    converged: bool | None
    checked_at: str | None
    check: str | None
    """Verdict of the last check: the worst of its figures."""
    due_on: str | None
    due_days: int | None
    """Negative: overdue."""


class BenchInfo(Said):
    """All of it."""

    cards: list[Card]
    unfinished: list[Unfinished]
