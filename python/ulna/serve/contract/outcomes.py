"""What checks and acceptance tests found."""

from __future__ import annotations

from ulna.serve.contract.model import Said, Sentence, Sha256, Value


class CheckedFigure(Said):
    """A figure of one place of a check."""

    test: str
    key: str
    """Its short name."""
    name: Sentence
    of: list[tuple[str, str]]
    """Labels of the measurement: ("artefact", "stick"), …"""
    value: Value
    limit: Value | None
    verdict: str | None
    why: Sentence | None
    """Why there is no verdict."""
    centre_mm: float | None
    """Of its own history, as all that follows."""
    lower_mm: float | None
    upper_mm: float | None
    average_mm: float | None
    in_control: bool | None
    signals: list[Sentence]
    history: Sentence | None
    """On how many earlier checks that rests."""


class Advised(Said):
    """What to try where figures of a test are out."""

    test: str
    figures: list[str]
    why: list[Sentence]
    steps: list[Sentence]
    """In the order of what it costs."""


class CheckOutcome(Said):
    """What a check found."""

    sha256: Sha256
    protocol: str
    arm: str
    at: str
    operator: str | None
    verdict: str | None
    in_control: bool | None
    figures: list[CheckedFigure]
    departures: list[Sentence]
    """Where what was measured is not what the protocol counts."""
    advice: list[Advised]
    remarks: list[Sentence]


class TestFigure(Said):
    """A figure of an acceptance test: its worst value."""

    key: str
    name: Sentence
    formula: Sentence
    value: Value
    limit: Value | None
    verdict: str | None
    why: Sentence | None
    values: int
    """Of so many."""


class TestedInfo(Said):
    """One test in one state of the arm."""

    test: str
    kind: str
    readings: int
    verdict: str | None
    departures: list[Sentence]
    figures: list[TestFigure]


class StateInfo(Said):
    """All tests in one state of the arm."""

    state: str
    verdict: str | None
    departures: list[Sentence]
    tests: list[TestedInfo]


class VerificationOutcome(Said):
    """What an acceptance test found."""

    sha256: Sha256
    arm: str
    profile: str
    standard: str
    statement: Sentence
    decision: Sentence
    verdict: str | None
    states: list[StateInfo]
    """As found before as left."""
    remarks: list[Sentence]
