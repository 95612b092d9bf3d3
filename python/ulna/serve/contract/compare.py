"""What has moved between calibrations of one arm."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256, Value
from ulna.serve.contract.results import Block


class CompareAsked(Asked):
    """Two to six results of one arm, the earliest first; or the last of an arm of the record."""

    results: Annotated[list[Sha256], Field(max_length=6)] | None = None
    arm: Name | None = None
    """Of the record."""
    last: Annotated[int, Field(ge=2, le=6)] = 2
    """So many of its calibrations."""
    probe: Name | None = None
    shared_u: Annotated[float, Field(ge=0, lt=0.01)] = 0.0
    """u of the artefact on which all rest over its length; 0: they share none."""
    language: Literal["en", "de", "zh"] = "en"


class Band(Said):
    """Lengths of a like size."""

    least_mm: float
    most_mm: float
    count: int
    rms: Value
    """Of the differences, later less earlier."""
    largest: Value
    """With its U for 95 %."""
    length_mm: float
    """Of the length that changed most."""
    at_mm: tuple[float, float, float]
    """Its middle."""
    en: float


class MovedParameter(Said):
    """A parameter whose difference is known."""

    name: str
    change: Value
    ratio: float
    """Its size by its standard uncertainty."""


class Step(Said):
    """One calibration beside the next."""

    before: str
    after: str
    moved: bool
    """By more than both uncertainties explain."""
    p_value: float
    p_of_largest: float
    chi2: float
    rank: int
    not_determined: int
    bands: list[Band]
    parameters: list[MovedParameter]
    """The surest first."""
    between: list[Sentence]
    """What was done to the arm meanwhile."""
    blocks: list[Block]
    """The same in the language that was asked for."""


class Compared(Said):
    """All of them."""

    steps: list[Step]
