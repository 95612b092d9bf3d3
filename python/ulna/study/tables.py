"""The tables of a study file, `ulna-study/1`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from ulna.arm.effects.effects import Extra
from ulna.arm.payload import PayloadTable
from ulna.arm.stated import PositiveEach, each_kind
from ulna.artefacts.lent import StatedOrLent
from ulna.formats.models import Strict, table_or_plain
from ulna.formats.numbers import Positive
from ulna.formats.units import Units
from ulna.study.data import Loss, Method
from ulna.study.readings.columns import ReadingsEntry

Extras = Annotated[
    Annotated[Literal["auto"], Tag("<all>")] | Annotated[list[Extra], Tag("<each>")], Discriminator(each_kind)
]


class NoiseTable(Strict):
    """Standard deviations of the readings."""

    encoder: PositiveEach | None = None
    """In the study's angle unit; one number, or one per joint."""
    seat: Positive | None = None
    """Of a touch, per coordinate, in the study's length unit."""


class PriorTable(Strict):
    """What is known of parameters before any reading."""

    value: float | None = None
    """The arm file's, or the artefact's, where it is not given."""
    u: Positive
    """Standard deviation."""


PriorValue = Annotated[
    Annotated[Positive, Tag("<plain>")] | Annotated[PriorTable, Tag("<table>")], Discriminator(table_or_plain)
]


class FittedTable(Strict):
    """What is fitted."""

    hold: list[str] = Field(default_factory=list)
    """Not fitted: shell-style patterns over parameter names."""
    free: list[str] = Field(default_factory=lambda: ["*"])
    """What may be fitted; hold wins."""
    loss: Loss = "none"
    """How residuals count that are far off: by their squares (none), or less."""
    start: Literal["given", "search"] = "given"
    """"search": the zero offsets are not known, find them."""
    extras: Extras = Field(default_factory=list)
    """Blocks of the model beyond geometry; each is judged by readings left out. "auto": blocks, orders of harmonics and
    priors are chosen by readings left out."""
    harmonics: list[Annotated[int, Field(ge=1, le=100)]] = Field(default_factory=lambda: [1, 2], min_length=1)
    """Orders of the encoders' harmonics, where extras ask for them."""
    judge_extras: bool = True
    """Whether extras are judged by cross-validation; false saves its time."""


class FitTable(FittedTable):
    """What is fitted, and how."""

    prior: dict[str, PriorValue] = Field(default_factory=dict)
    """Pattern of parameter names = standard deviation around the arm file's value, or { value, u }, in the study's
    units."""
    judge: bool = False
    """Whether a map of the residuals says if they still follow the turn of a joint; needs Ulna's extra `judge`."""
    method: Method = "lm"
    """"annealing" or "evolution": first a search of a box around the start without derivatives."""
    budget: Annotated[int, Field(ge=100, le=1_000_000_000)] = 100_000
    """Most evaluations of the sum of squares in that search."""
    box_length: Positive | None = None
    """Half the width of the box for lengths (default 100 mm)."""
    box_angle: Positive | None = None
    """For twists (default 0.2 rad)."""
    box_offset: Positive | None = None
    """For zero offsets (default 1 rad; with start "search" the whole turn)."""
    seed: Annotated[int, Field(ge=0, le=2**63 - 1)] = 0
    max_iterations: Annotated[int, Field(ge=1, le=1_000_000)] = 200
    known_length: Positive | None = None
    """How well lengths are known before any reading (default 1 mm); worse-determined parameters are called weak."""
    known_angle: Positive | None = None
    """The same for angles (default 0.01 rad)."""
    poor_above: Positive | None = None
    """Residuals, root mean square, above which the fit did not converge but ended in a poor minimum (default: a
    thousandth of the reach, unless the stated noise explains more)."""


class StudyFile(Strict):
    """What to fit to what: `ulna-study/1`."""

    format: Literal["ulna-study/1"]
    arm: str
    """Path of the arm file, relative to the study file."""
    units: Units
    readings: Annotated[list[ReadingsEntry], Field(min_length=1)]
    artefact: Annotated[dict[str, StatedOrLent], Field(min_length=1)]
    payload: dict[str, PayloadTable] | None = None
    """What the arm carried beside its own masses, by name; readings say which. For compliance."""
    carried: str | None = None
    """Which of them in all readings that do not say it themselves; "none": no load."""
    noise: NoiseTable | None = None
    fit: FitTable = Field(default_factory=FitTable)
