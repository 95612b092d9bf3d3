"""Tables that somebody brings: what they look like, what they are taken for, and the study that is made of them."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.files import FileInfo
from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256

Positive = Annotated[float, Field(gt=0, le=1e6)]
Word = Annotated[str, Field(min_length=1, max_length=200)]
Short = Annotated[str, Field(min_length=1, max_length=20)]


class TouchedAsked(Asked):
    """An artefact that was touched; what is not said is asked for."""

    kind: Name
    name: Name | None = None
    """In the study, and in a column that names artefacts."""
    length_mm: Positive | None = None
    diameter_mm: Positive | None = None
    features: Sha256 | None = None
    """A table of feature, x, y, z on the desk."""
    u_mm: Positive | None = None
    """Standard uncertainty."""


class LayoutAsked(Asked):
    """How a table is written, where it is not seen: as the options of `ulna new` have it."""

    sheet: Word | None = None
    dataset: Word | None = None
    separator: Short | None = None
    decimal: Short | None = None
    thousands: Short | None = None
    encoding: Short | None = None
    comment: Short | None = None
    header: Annotated[int, Field(ge=1, le=10_000)] | None = None
    """Line with the columns' names."""
    units_row: bool | None = None


class ColumnSaid(Asked):
    """What a column of the file is."""

    ours: Name
    """q1, placement, feature, …"""
    theirs: Word


class LabelSaid(Asked):
    """What a label in a column is."""

    column: Name
    """Ulna's name of it."""
    ours: Name
    theirs: Word


class ArmSaid(Asked):
    """The arm: one that is drawn, or how long it is."""

    arm: Sha256 | None = None
    """An arm file, or a result."""
    urdf: Sha256 | None = None
    tip_link: Word | None = None
    base_link: Word | None = None
    dh: Sha256 | None = None
    convention: Literal["dh", "modified-dh"] | None = None
    angle_unit: Literal["rad", "deg"] | None = None
    tip: Annotated[list[float], Field(min_length=3, max_length=3)] | None = None
    reach_mm: Positive | None = None
    """From base to tip, where there is no drawing."""
    parallel: Annotated[list[Word], Field(max_length=16)] | None = None
    """With a reach: axes that are parallel to the next, by their numbers; or "none"."""
    zeros: Literal["known", "unknown"] | None = None
    signs: Literal["known", "unknown"] | None = None
    counts_per_turn: Annotated[list[Positive], Field(max_length=16)] | None = None
    ball_mm: Positive | None = None
    """Diameter of the probe's ball."""


class StudyAsked(Asked):
    """All that is said of files of readings; what is not is found in them, or asked for."""

    files: Annotated[list[Sha256], Field(min_length=1, max_length=20)]
    touched: Annotated[list[TouchedAsked], Field(max_length=20, default_factory=list)]
    """One for each file, one for all, or one for each name in a column."""
    arm: ArmSaid = ArmSaid()
    layout: LayoutAsked = LayoutAsked()
    columns: Annotated[list[ColumnSaid], Field(max_length=200, default_factory=list)]
    labels: Annotated[list[LabelSaid], Field(max_length=1000, default_factory=list)]
    angle: Literal["rad", "deg", "counts"] | None = None
    length_unit: Literal["mm", "m", "in"] | None = None
    one_standing: bool = False
    """The artefact was never moved."""
    skip_bad: bool = False
    """Rows without a number are left out."""


class ColumnSeen(Said):
    """One column."""

    name: str
    """The file's."""
    taken_for: str | None
    """Ulna's name; "": not used; None: not settled, as something must be said first."""
    why: Sentence
    unit: str
    numeric: bool
    filled: int
    bad: list[str]
    """Where no number stands in a column of numbers, in the file's own words; 20 at most."""


class RowSeen(Said):
    """One row, as it stands."""

    at: str
    """In the file's own words: "line 7", "row 3"."""
    cells: list[str]


class TableSeen(Said):
    """One file, looked at."""

    file: FileInfo
    head: str
    """Where the columns' names stand."""
    seen: list[tuple[str, str]]
    """How it is written, as far as that was found: ("separator", ";")."""
    columns: list[ColumnSeen]
    first: list[RowSeen]
    """The first rows."""
    rows: int
    remarks: list[Sentence]


class QuestionSaid(Said):
    """What nobody has said, and the files do not say."""

    field: str
    """length, reach, drawing, standing, …"""
    asks: Sentence
    choices: list[str]
    about: str
    """Of which artefact; "" of all."""
    flag: str
    """What answers it on a command line."""


class ProposalSaid(Said):
    """A study that can be written."""

    arm: Sentence
    joints: int
    search: bool
    """Whether the encoders' zeros are searched for."""
    signs_unknown: bool
    angle: str
    angle_why: Sentence
    artefacts: list[Sentence]
    rows: int
    remarks: list[Sentence]


class Looked(Said):
    """What became of looking: a proposal, or questions, or what is wrong."""

    tables: list[TableSeen]
    proposal: ProposalSaid | None
    questions: list[QuestionSaid]
    wrong: Sentence | None
    """Which cell, key or file, what was expected, what to do."""


class StudyMade(Said):
    """A study on the desk."""

    study: FileInfo
    arm: FileInfo
    proposal: ProposalSaid
    determined: int
    parameters: int
    sentences: list[Sentence]
    """What its readings do not determine, and why."""
