"""The tables of a profile, `ulna-profile/1`: which tests there are, how much is measured, how it is decided."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.formats.models import OneOf, Strict
from ulna.formats.units import LengthUnit
from ulna.verification.kinds.kind import TestTable
from ulna.verification.kinds.registry import KINDS
from ulna.verification.limits import DecisionTable, LimitValue

AnyTest = Annotated[TestTable, OneOf({name: kind.table for name, kind in KINDS.items()})]


class ProfileFile(Strict):
    """What is tested and how it is decided: `ulna-profile/1`."""

    format: Literal["ulna-profile/1"]
    name: str
    based_on: str | None = None
    """Name or path of another profile: what is not said here is as there."""
    standard: str
    statement: str
    """What reports say of it."""
    decision: DecisionTable
    test: Annotated[dict[str, AnyTest], Field(min_length=1)]
    """By name."""
    without: list[str] = Field(default_factory=list)
    """Tests of the profile that this is based on, left out."""
    unit: LengthUnit | None = None
    """Of the limits."""
    limit: dict[str, LimitValue] = Field(default_factory=dict)
    """Maximum permissible errors, by the short name of a figure; those of a verify file come first."""
