"""What the files of results hold: `ulna-result/1`, `ulna-evaluation/1`, `ulna-cross-validation/1`, all JSON.

These models are the formats' definition: the JSON Schemas are made from them, and tests hold what the commands write to
them. Further keys may be added within a version, so a reader must pass over keys that it does not know. Lengths in mm,
angles in rad.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from ulna.arm.effects.effects import Extra
from ulna.arm.joint_file import JointTable
from ulna.arm.tables import CartesianTip


class Open(BaseModel):
    """A table of a file that Ulna writes: later versions may add keys."""

    model_config = ConfigDict(strict=True, extra="allow", allow_inf_nan=False, defer_build=True)


class ResultProbe(Open):
    """One probe of the calibrated arm."""

    tip: CartesianTip
    ball: float | None = None


class ResultArm(Open):
    """The calibrated arm, with the keys of an arm file, in mm and rad."""

    name: str
    full_last_link: bool = False
    gravity: list[float] | None = None
    joint: Annotated[list[JointTable], Field(min_length=2)]
    probe: Annotated[dict[str, ResultProbe], Field(min_length=1)]


class PriorEntry(Open):
    """What was known of a parameter before any reading, in its unit."""

    value: float
    u: float


class ParameterEntry(Open):
    """One parameter before and after: of the arm, or a dimension of an artefact that was fitted."""

    name: str
    unit: Literal["rad", "mm", "1/K", "rad/(N m)"]
    start: float
    value: float
    u: float | None
    """Standard uncertainty; null where held, not determined or not to be estimated."""
    status: Literal["fitted", "held", "not-determined"]
    prior: PriorEntry | None = None
    """Where the fit used one."""


class CovarianceEntry(Open):
    """Of the parameters that were free, rad and mm."""

    names: list[str]
    matrix: list[list[float | None]]
    """Square, in the order of names; null where it cannot be estimated."""


class LostEntry(Open):
    """A direction of the parameters that the readings do not determine."""

    combination: dict[str, float]
    """Moving the parameters by these weights changes no residual."""
    because: str
    remedy: str


class IdentifiabilityEntry(Open):
    """What the readings determine."""

    parameters: int
    """Free parameters asked about."""
    determined: int
    singular_values: list[float]
    """Of the Jacobian with columns scaled to unit norm, placements eliminated; descending."""
    lost: list[LostEntry]
    from_prior: list[str] = Field(default_factory=list)
    """Parameters of which the readings say next to nothing."""


class FitEntry(Open):
    """How the fit ended."""

    termination: str
    converged: bool
    iterations: int
    cost_start: float
    cost: float
    rms_start_mm: float
    rms_mm: float
    readings: int
    degrees_of_freedom: int
    chi2_per_dof: float | None = None
    """Only with stated noise; 1 where the noise is right."""
    undecided_signs: list[list[int]] = Field(default_factory=list)
    """Sets of joints, from 1, whose encoders may all count the other way."""
    method: Literal["lm", "annealing", "evolution"] = "lm"
    box_evaluations: int = 0
    """Of the search of a box, where the method asks for one."""
    loss: Literal["none", "huber", "cauchy", "tukey"] = "none"
    scatter: dict[str, float] = Field(default_factory=dict)
    """Of each artefact's readings, from the median: in units of the stated noise, or mm where none is stated."""


class ResidualEntry(Open):
    """One reading: x, y, z of tip minus feature in the base frame, for a length row length_mm, for a touch of a surface
    distance_mm."""

    row: int
    """Data row of the file, from 1."""
    file: str
    artefact: str
    placement: str
    probe: str
    feature: str | None = None
    x_mm: float | None = None
    y_mm: float | None = None
    z_mm: float | None = None
    length_mm: float | None = None
    distance_mm: float | None = None
    norm_mm: float
    weight: float
    """Root of the reading's weight, 1/mm; 1 where no noise is stated."""
    times_scatter: float | None = None
    """How far off, in units of the scatter of its artefact's readings."""
    outlier: bool | None = None
    """Whether farther off than one normal reading in ten thousand."""
    counted: float | None = None
    """What a loss let it count, 0 to 1."""


class OutlierEntry(Open):
    """A reading far off the rest of its artefact's."""

    row: int
    file: str
    artefact: str
    placement: str
    feature: str | None = None
    probe: str
    norm_mm: float
    times_scatter: float
    counted: float | None = None


class ExtraEntry(Open):
    """A block beyond geometry, judged by readings left out."""

    extra: Extra
    figure: str
    """Which figure, mean over the groups left out."""
    without_mm: float
    with_mm: float
    better_by_mm: float
    u_better_by_mm: float | None
    """Standard error over the groups."""
    groups: int
    by: str
    verdict: Literal["earned", "undecided", "not-earned"]
    order: int | None = None


class Figures(Open):
    """What a metrologist reads, from the readings alone. Only the figures that the artefact gives, in mm."""

    seat_scatter_mean_mm: float | None = None
    """Distance of each touch to the mean of its own seat's touches."""
    seat_scatter_max_mm: float | None = None
    length_error_mean_abs_mm: float | None = None
    """Distance between the means of two seats minus the calibrated length."""
    length_error_rms_mm: float | None = None
    length_error_max_abs_mm: float | None = None
    coordinate_error_mean_mm: float | None = None
    """Distance to the reference coordinates after the best rigid fit."""
    form_mm: float | None = None
    """Spread of distances from the least-squares sphere or plane; the largest of all placements."""
    diameter_error_mm: float | None = None
    """Of the least-squares sphere, signed; the largest in size of all placements."""


class ArtefactEntry(Figures):
    """The figures of one artefact in one placement."""

    artefact: str
    placement: str


class ProvenanceEntry(Open):
    """From what, with what and when it was made."""

    version: str
    files: list[dict[str, str | int]]
    """path, sha256 and rows of each input file."""
    time: str


class ResultFile(Open):
    """A calibration: `ulna-result/1`."""

    format: Literal["ulna-result/1"]
    arm: ResultArm
    parameters: list[ParameterEntry]
    covariance: CovarianceEntry
    identifiability: IdentifiabilityEntry
    fit: FitEntry
    outliers: list[OutlierEntry] = Field(default_factory=list)
    """Readings far off the rest, the farthest first."""
    extras: list[ExtraEntry] = Field(default_factory=list)
    """Blocks beyond geometry, each judged by readings left out."""
    artefacts: list[ArtefactEntry]
    provenance: ProvenanceEntry
    residuals: list[ResidualEntry]


class EvaluationFile(Open):
    """An arm, unchanged, on readings: `ulna-evaluation/1`."""

    format: Literal["ulna-evaluation/1"]
    parameters: dict[str, float] | None = None
    """Name → value of the arm that was judged (mm, rad, 1/K, rad/(N m)); absent in files of earlier versions."""
    artefacts: list[ArtefactEntry]
    overall: Figures
    """Over all readings together."""


class GroupEntry(Open):
    """What was left out, judged by the arm before and by the arm fitted to the rest."""

    group: str
    before: Figures
    after: Figures


class CrossValidationFile(Open):
    """Each group left out once: `ulna-cross-validation/1`."""

    format: Literal["ulna-cross-validation/1"]
    groups: list[GroupEntry]
    before: Figures
    """The mean of the groups' figures."""
    after: Figures
