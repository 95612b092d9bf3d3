"""The record: equipment and what became of it, figures over time, what is due."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256, Value

Day = Annotated[str, Field(min_length=4, max_length=40)]
"""A day or a time, ISO 8601."""
Long = Annotated[str, Field(min_length=1, max_length=2000)]
Kind = Literal["arm", "robot", "probe", "artefact", "thermometer"]
EventKind = Literal["knock", "repair", "move", "adjustment", "firmware", "quarantine", "release", "note"]
Method = Literal["staircase", "drift", "a3"]


class RegisterAsked(Asked):
    """Equipment: new, or as it is from now on. What is not said stays as it was."""

    name: Name
    kind: Kind
    state: Literal["in use", "quarantined", "retired"] | None = None
    part_of: Name | None = None
    maker: Name | None = None
    model: Name | None = None
    serial: Name | None = None
    firmware: Name | None = None
    owner: Name | None = None
    location: Name | None = None
    remark: Name | None = None


class EventAsked(Asked):
    """What happened to equipment."""

    kind: EventKind
    text: Long
    at: Day | None = None
    file: Sha256 | None = None


class IntervalAsked(Asked):
    """When it must come back, as somebody decided."""

    days: Annotated[float, Field(ge=1, le=36525)]
    method: Name | None = None
    why: Long | None = None


class Equipment(Said):
    """One thing of the record, as it is now."""

    name: str
    kind: str
    state: str
    part_of: str | None
    maker: str | None
    model: str | None
    serial: str | None
    firmware: str | None
    owner: str | None
    location: str | None
    remark: str | None
    due_on: str | None
    due_days: int | None
    """Negative: overdue."""
    due_why: Sentence | None


class AllEquipment(Said):
    """All of it, by name."""

    equipment: list[Equipment]


class Happening(Said):
    """One line of a history."""

    number: int
    """Of the entry in the record's chain."""
    at: str
    what: Sentence
    text: Sentence
    by: str
    sha256: Sha256 | None
    """Of the file, where there is one."""


class Series(Said):
    """A figure that is there over time."""

    figure: str
    state: str
    artefact: str | None
    count: int
    last: str


class FiledCalibration(Said):
    """A calibration of the record that counts."""

    sha256: Sha256
    at: str
    converged: bool
    ending: str
    on_desk: bool
    """Whether it can be looked at: GET /results of its hash."""


class CertifiedValue(Said):
    """What a certificate says of an artefact."""

    quantity: str
    value: Value
    temperature_c: float | None
    number: str | None
    by: str | None
    valid_from: str | None
    valid_to: str | None
    certificate: Sha256 | None
    newest: bool
    """Of its quantity."""


class IssuedInfo(Said):
    """A certificate that was issued."""

    number: str
    arm: str
    sha256: Sha256
    issued_at: str
    issued_by: str
    approved_by: str | None
    supersedes: str | None
    state: str
    """in force, superseded, withdrawn."""
    reason: str
    result: Sha256 | None


class EquipmentWhole(Said):
    """One thing, and what became of it."""

    equipment: Equipment
    history: list[Happening]
    """The newest first."""
    series: list[Series]
    calibrations: list[FiledCalibration]
    """The newest first."""
    values: list[CertifiedValue]
    certificates: list[IssuedInfo]


class FigurePoint(Said):
    """A figure at one time."""

    at: str
    value: Value
    limit: Value | None
    verdict: str | None
    source: str
    state: str
    artefact: str | None
    sha256: Sha256
    outside: bool
    """Of the control limits."""


class Trend(Said):
    """A figure over time."""

    arm: str
    figure: str
    unit: str
    points: list[FigurePoint]
    """The earliest first."""
    baseline: int
    """So many of the first figures make the control limits."""
    centre: float | None
    lower: float | None
    upper: float | None
    in_control: bool | None
    drifts: bool | None
    interval_days: float | None
    """Until it meets its limit."""
    sentences: list[Sentence]
    """Of drift, limit and chart, as `ulna record trend` says them."""
    breaks: list[Sentence]
    """What happened meanwhile that may have changed the arm."""


class FigurePoints(Said):
    """A figure over time, without anything made of it."""

    points: list[FigurePoint]


class Advice(Said):
    """When it should come back, by one method."""

    method: str
    days: float | None
    """None: too few to go by."""
    now_days: float | None
    rests_on: int
    reason: Sentence


class AllAdvice(Said):
    """By each method that can be asked."""

    advice: list[Advice]


class Impact(Said):
    """What was done between the last good figure and the first bad one."""

    name: str
    good: str | None
    bad: str
    why: Sentence
    touched: list[Happening]
    certificates: list[str]
    """Numbers, for recall."""


class DueInfo(Said):
    """Equipment that must come back."""

    name: str
    kind: str
    state: str
    due_on: str | None
    days: int | None
    why: str


class AllDue(Said):
    """The soonest first."""

    due: list[DueInfo]
