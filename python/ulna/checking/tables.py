"""The tables of a protocol, `ulna-protocol/1`: what a check touches, its limits, and how its history is judged."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.control.shewhart import BEYOND_3, FEWEST
from ulna.formats.models import Strict
from ulna.formats.numbers import Amount
from ulna.formats.units import Units
from ulna.verification.certified import AnyArtefact
from ulna.verification.limits import DecisionTable, LimitValue
from ulna.verification.profile_tables import AnyTest
from ulna.verification.tables import FixtureTable, TouchKeys, VerifyTemperature

Row = Literal["two-of-three", "four-of-five", "eight-on-one-side", "six-rising"]


class ControlTable(Strict):
    """How figures are judged by those of earlier checks."""

    baseline: Annotated[int, Field(ge=FEWEST, le=1000)] = 10
    """How many of the first checks are taken for a time when all was well; until there are so many, all earlier."""
    fewest: Annotated[int, Field(ge=3, le=1000)] = FEWEST
    """Earlier checks without which nothing is said."""
    alpha: Annotated[float, Field(ge=1e-6, le=0.2)] = BEYOND_3
    """How often a figure, and its average, is outside by chance."""
    weight: Annotated[float, Field(gt=0, le=1)] = 0.2
    """λ of the average: how much the latest figure counts in it."""
    rows: list[Row] = Field(default_factory=list)
    """Rules about figures in a row that count as out of control; what the others find is told only, for each finds
    something in one of fifty to a hundred figures of a steady arm."""


class ProtocolFile(Strict):
    """What is touched in a check, and how it is judged: `ulna-protocol/1`."""

    format: Literal["ulna-protocol/1"]
    name: str
    """What reports call it; the history of a check is of one name."""
    units: Units
    """Of this file and of its readings."""
    arm: str | None = None
    """Path of the arm file or result, relative to the protocol, that turns encoder readings into points; left out for
    readings as x, y, z."""
    item: str | None = None
    """What reports call the arm: maker, type, serial number. The arm file's name where it is not given."""
    ball: Amount | None = None
    """Diameter of the probe's ball, for readings as x, y, z; 0 where they are points of the surface already."""
    decision: DecisionTable
    test: Annotated[dict[str, AnyTest], Field(min_length=1)]
    """By name; of the kinds of acceptance tests."""
    limit: dict[str, LimitValue] = Field(default_factory=dict)
    """Limits by the short name of a figure; a figure without one has no verdict, and its history alone judges it."""
    artefact: dict[str, AnyArtefact] = Field(default_factory=dict)
    """By name."""
    temperature: VerifyTemperature | None = None
    fixture: FixtureTable | None = None
    readings: TouchKeys = Field(default_factory=TouchKeys)
    """How tables of readings are written, and what fills columns that they do not have."""
    control: ControlTable = Field(default_factory=ControlTable)
