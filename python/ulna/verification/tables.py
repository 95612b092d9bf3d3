"""The tables of a verify file, `ulna-verify/1`: the arm's limits, the artefacts, the readings."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.formats.layout import TableKeys
from ulna.formats.models import Strict
from ulna.formats.numbers import Amount, Positive
from ulna.formats.units import Units
from ulna.verification.certified import AnyArtefact
from ulna.verification.limits import LimitValue, ProcessTable, Rule

State = Literal["as-found", "as-left"]
STATES: tuple[State, ...] = ("as-found", "as-left")


class VerifyTemperature(Strict):
    """Of the artefacts while they were measured."""

    value: float
    """°C"""
    u: Amount
    """Standard uncertainty, K."""


class FixtureTable(Strict):
    """How still artefacts stand while they are measured."""

    u: Amount
    """Standard uncertainty that they add to a value."""


class TouchKeys(TableKeys):
    """Of a table of touches. All keys fill the column where the table has none."""

    angle: Literal["rad", "deg", "counts"] | None = None
    """Unit of encoder angles; the file's angle unit where it is not given."""
    probe: str | None = None
    """Of encoder readings: which probe was on."""
    payload: str | None = None
    """Of encoder readings: what was carried, the name of a [payload] of the arm, or "none"."""
    test: str | None = None
    """Which test of the profile."""
    artefact: str | None = None
    position: str | None = None
    orientation: str | None = None
    repeat: str | None = None
    feature: str | None = None
    """Which end of a length: A or B."""


class VerifyReadings(TouchKeys):
    """One file of touches."""

    file: str
    """Path, relative to the verify file."""
    state: State = "as-left"
    """Before or after calibration and repair."""
    arm: str | None = None
    """Of encoder readings: path of the arm file or result that turns these into points, in place of the command's ARM:
    the arm as found, say."""


class VerifyFile(Strict):
    """What was measured, with what: `ulna-verify/1`."""

    format: Literal["ulna-verify/1"]
    profile: str
    """One that comes with Ulna (iso-10360-12, asme-b89-4-22, vdi-2617-9), or the path of your own."""
    units: Units
    arm: str | None = None
    """What reports call the arm: maker, type, serial number. The arm file's name where it is not given."""
    ball: Amount | None = None
    """Diameter of the probe's ball, for readings as x, y, z; 0 where they are points of the surface already."""
    range: Positive | None = None
    """Diameter of the measuring range."""
    rule: Rule | None = None
    """The decision rule, in place of the profile's."""
    r: Positive | None = None
    """Of the rule "rU": the guard band as a part of U."""
    mpe: dict[str, LimitValue] = Field(default_factory=dict)
    """Maximum permissible errors, by the short name of a figure; a figure without one has no verdict."""
    process: dict[str, ProcessTable] = Field(default_factory=dict)
    """What is made, by the short name of a figure: without it there is no global risk of the rule."""
    scanner: str | None = None
    """What the arm carries beside its probe, such as a laser line scanner: reports say that it was not tested."""
    artefact: dict[str, AnyArtefact] = Field(default_factory=dict)
    """By name."""
    temperature: VerifyTemperature | None = None
    fixture: FixtureTable | None = None
    readings: Annotated[list[VerifyReadings], Field(min_length=1)]
