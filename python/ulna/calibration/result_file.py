"""What the files of results hold: `ulna-result/1`, `ulna-evaluation/1`, `ulna-cross-validation/1`, all JSON.

These models are the formats' definition: they write and read the files, and the JSON Schemas are made from them.
Entries that are the same in memory stand there as they are (`Parameter`, `FitSummary`, …). Further keys may be added
within a version, so a reader must pass over keys that it does not know. Lengths in mm, angles in rad.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field
from typing_extensions import TypedDict

from ulna.arm.joint_file import JointTable
from ulna.arm.payload import PayloadTable
from ulna.arm.tables import CartesianTip
from ulna.calibration.choosing.tried import ChosenModel
from ulna.calibration.coverage import Coverage
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.identify import Identification
from ulna.calibration.placements import FigureEntry, PlacementEntry
from ulna.calibration.poses import PlacementPose
from ulna.calibration.residual_map import ResidualMap
from ulna.calibration.residuals import ReadingEntry, ResidualEntry
from ulna.calibration.summary import FitSummary, GroupFigures, Parameter
from ulna.formats.models import Open


class ResultProbe(Open):
    """One probe of the calibrated arm."""

    tip: CartesianTip
    ball: float | None = None


class ResultArm(Open):
    """The calibrated arm, with the keys of an arm file, in mm and rad."""

    name: str
    full_last_link: bool = False
    gravity: list[float] | None = None
    payload: dict[str, PayloadTable] | None = None
    joint: Annotated[list[JointTable], Field(min_length=2)]
    probe: Annotated[dict[str, ResultProbe], Field(min_length=1)]


class CovarianceEntry(Open):
    """Of the parameters that were free, rad and mm."""

    names: list[str]
    matrix: list[list[float | None]]
    """Square, in the order of names; null where it cannot be estimated."""


class OutlierEntry(ReadingEntry):
    """A reading far off the rest of its artefact's."""

    norm_mm: float
    times_scatter: float
    counted: float | None = None
    place: str | None = None
    """Where the row stands in its file: "line 7", `Messung!A12`."""


class OverallEntry(Open):
    """Over all placements together."""

    before: FigureEntry
    """Of the arm that the fit started from."""
    after: FigureEntry
    """Of the calibrated arm."""
    without_far_off: FigureEntry | None = None
    """The same without the readings that are far off, where a loss let them count less."""


class FileEntry(TypedDict):
    """An input file, as the bytes were that were read."""

    __pydantic_config__ = ConfigDict(strict=True, extra="allow")  # type: ignore[misc]  # pydantic's own word

    path: str
    sha256: str
    rows: int


class ProvenanceEntry(Open):
    """From what, with what and when it was made."""

    program: str = "ulna"
    version: str
    study: str | None = None
    """Path of the study file; null of one made in memory."""
    rows: Literal["fit", "check", "all"] | None = None
    """Which rows of the study, where it keeps some to check the fit."""
    files: list[FileEntry]
    """Each input file."""
    options: dict[str, Any] = Field(default_factory=dict)
    """What was asked of the fit."""
    seed: int = 0
    noise: dict[str, Any] | None = None
    """encoder_rad and seat_mm, as the study stated them."""
    warnings: list[str] = Field(default_factory=list)
    time: str
    duration_s: float | None = None


class TableBeside(Open):
    """A Parquet file beside this one, with a row for each entry of the list whose place it takes."""

    file: str
    """Its name, in the same folder."""
    sha256: str
    rows: int


class ResultFile(Open):
    """A calibration: `ulna-result/1`."""

    format: Literal["ulna-result/1"]
    arm: ResultArm
    parameters: list[Parameter]
    probes: dict[str, dict[str, Any]] = Field(default_factory=dict)
    """Each tip as x, y, z and as theta0, r, h, with standard uncertainties."""
    covariance: CovarianceEntry
    identifiability: Identification
    fit: FitSummary
    outliers: list[OutlierEntry] = Field(default_factory=list)
    """Readings far off the rest, the farthest first."""
    extras: list[JudgedExtra] = Field(default_factory=list)
    """Blocks beyond geometry, each judged by readings left out."""
    chosen: ChosenModel | None = None
    """Where the study left the blocks to Ulna: which model was chosen, and all that was tried."""
    residual_map: ResidualMap | None = None
    """Where the study asked for it: whether residuals still follow the turn of a joint."""
    artefacts: list[PlacementEntry] = Field(default_factory=list)
    """Of each placement, in the order of the study."""
    artefacts_file: TableBeside | None = None
    """Has them in place of the list above where there are very many placements."""
    placements: list[PlacementPose] = Field(default_factory=list)
    """Where each standing of an artefact with features was found, in the arm's base frame; of no more than 20 000."""
    overall: OverallEntry
    provenance: ProvenanceEntry
    residuals: list[ResidualEntry] = Field(default_factory=list)
    """One for each reading, in the order of the study."""
    residuals_file: TableBeside | None = None
    """Has them in place of the list above where there are very many readings."""


class EvaluatedEntry(Open):
    """How well the readings are met, the placements fitted by least squares."""

    readings: int
    rms_mm: float


class EvaluationFile(Open):
    """An arm, unchanged, on readings: `ulna-evaluation/1`."""

    format: Literal["ulna-evaluation/1"]
    arm: str | None = None
    """Its name."""
    parameters: dict[str, float] | None = None
    """Name → value of the arm that was judged (mm, rad, 1/K, rad/(N m)); absent in files of earlier versions."""
    artefacts: list[PlacementEntry]
    overall: FigureEntry
    """Over all readings together."""
    fit: EvaluatedEntry | None = None
    provenance: ProvenanceEntry | None = None
    coverage: Coverage | None = None
    """Whether the uncertainties that were stated of the arm hold."""


class CrossValidationFile(Open):
    """Each group left out once: `ulna-cross-validation/1`."""

    format: Literal["ulna-cross-validation/1"]
    by: str | None = None
    """What a group is."""
    groups: list[GroupFigures]
    before: FigureEntry
    """The mean of the groups' figures."""
    after: FigureEntry
    provenance: ProvenanceEntry | None = None
    coverage: Coverage | None = None
    """Whether the uncertainties that each fit states hold on what was left out."""
