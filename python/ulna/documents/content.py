"""What a report says: numbers and statements, no markup and no language. Each rendering shows all of it.

Lengths in mm, angles in rad unless a name says otherwise. What the data do not allow is None here and has a statement
in `Content.missing` that says what would be needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ulna.arm.probes import ProbeView
from ulna.calibration.identify import Identification
from ulna.calibration.placements import PlacementFigures
from ulna.calibration.summary import FitSummary

if TYPE_CHECKING:
    from ulna.calibration.extras import JudgedExtra
    from ulna.documents.laboratory.file import Laboratory
    from ulna.verification.result_file import VerificationFile

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Bool = NDArray[np.bool_]


@dataclass(frozen=True)
class Said:
    """One sentence: a key of `ulna.documents.languages.words` and the values that fill it."""

    key: str
    values: dict[str, Any] = field(default_factory=dict)
    """Text and numbers, as they are; the rendering escapes and rounds."""


@dataclass(frozen=True)
class Summary:
    """What a table of errors shows, mm."""

    mean_mm: float
    """Signed for length errors; of distances, which are positive, just their mean; NaN where it is not known."""
    rms_mm: float
    max_mm: float
    """Largest size."""

    @property
    def two_sigma_mm(self) -> float:
        """2 √(RMS² - mean²): twice the standard deviation about the mean (of n, not n - 1); NaN if not known."""
        variance = self.rms_mm**2 - self.mean_mm**2
        return variance if np.isnan(variance) else 2.0 * float(np.sqrt(max(variance, 0.0)))


@dataclass(frozen=True)
class QualityRow:
    """One quantity on one set of readings, before and after."""

    quantity: str
    """"length_error", "seat_scatter", "coordinate_error", "form", "diameter_error", or "residual": its size."""
    readings: str
    """"fitted"; "check" (rows of the study that were kept), "left-out" (cross-validation) or "evaluated": held out."""
    before: Summary | None
    after: Summary | None
    signed: bool
    """Whether the mean is of signed errors."""


@dataclass(frozen=True)
class Sample:
    """Errors of one kind and their distribution."""

    artefact: str
    kind: str
    """"length" (length rows; bars touched once at each end), "component" (x, y, z of point readings) or "distance"
    (touches of a surface)."""
    value_mm: F64
    """(N,)"""
    edges_mm: F64
    """(B + 1,) of the histogram."""
    counts: I64
    """(B,)"""
    mean_mm: float
    sigma_mm: float
    """Standard deviation (divided by n - 1)."""
    quantile: F64
    """(N,) of the standard normal distribution, ascending: Filliben's medians of order statistics."""
    ordered_mm: F64
    """(N,) the errors, ascending: of a normal distribution a straight line over `quantile`."""


@dataclass(frozen=True)
class Trend:
    """Means over equal ranges of an abscissa: what a cloud hides."""

    x: F64
    """(B,) middle of each range; ranges with fewer than three readings are left out."""
    mean_mm: F64
    u_mm: F64
    """(B,) standard uncertainty of each mean."""


@dataclass(frozen=True)
class Cloud:
    """Residuals over something."""

    over: str
    """"joint", "reach" or "temperature"."""
    joint: int
    """From 1; 0 where it is no joint (or one temperature for all)."""
    x: F64
    """(N,) degrees, mm or °C."""
    residual_mm: F64
    """(N,) over a joint: along the motion of the tip (or the change of the length) that this joint causes, signed;
    else the residual's size."""
    reading: I64
    """(N,) index into `Readings`; length rows appear twice, once for each pose."""
    trend: Trend


@dataclass(frozen=True)
class Quiver:
    """Residual vectors in space. Touches of surfaces, whose residual has no direction of its own, are not in it."""

    at_mm: F64
    """(N, 3) the tip, in the base frame; of length rows the second pose."""
    vector_mm: F64
    """(N, 3) the residual; of length rows along the length."""
    reading: I64
    """(N,) index into `Readings`."""


@dataclass(frozen=True)
class ReadingRows:
    """The fitted readings in their order, N of them."""

    row: I64
    """(N,) of their file, from 1."""
    file: list[str]
    artefact: list[str]
    placement: list[str]
    size_mm: F64
    """(N,) the residual's size."""
    outlier: Bool
    """(N,) farther off than one normal reading in ten thousand."""


@dataclass(frozen=True)
class ParameterRow:
    """One parameter."""

    name: str
    unit: str
    nominal: float
    estimate: float
    u: float | None
    """Standard uncertainty; None where held, not determined or not to be estimated."""
    expanded: float | None
    """U = k u."""
    ratio: float | None
    """(estimate - nominal) / u."""
    status: str
    """"fitted", "held" or "not-determined"."""
    cause: str | None
    """Why it is not determined, by its key: "base-frame", "probe-on-axis", …; None where it is, or nobody knows."""
    reason: str | None
    """The same in the words of the identification (English)."""


@dataclass(frozen=True)
class Parameters:
    """The parameters and what is known of them."""

    rows: list[ParameterRow]
    k: float
    """Coverage factor of every U."""
    p: float
    """Coverage probability that k stands for."""
    degrees_of_freedom: float
    """Infinite where the noise is stated, so that u does not come from the residuals."""
    probes: list[ProbeView]
    correlation_names: list[str]
    correlation: F64
    """(k, k), NaN where it is not known."""


@dataclass(frozen=True)
class Observability:
    """How well the readings determine the parameters."""

    singular_values: F64
    """(k,) descending, of the Jacobian with columns of unit norm, placements eliminated."""
    determined: int
    indices: dict[str, float]
    """O1 to O5 over the determined directions, columns scaled to a root mean square of one over the equations."""
    equations: int
    """Equations less the unknowns of the placements."""


@dataclass(frozen=True)
class Lengths:
    """Length errors over lengths, of the fitted readings."""

    length_mm: F64
    """(N,) calibrated."""
    error_mm: F64
    """(N,) measured minus calibrated."""


@dataclass(frozen=True)
class TestedLengths:
    """Length errors of an acceptance test over their lengths."""

    __test__ = False  # no test of pytest's

    state: str
    """"as-found" or "as-left"."""
    test: str
    figure: str
    length_mm: F64
    """(N,) calibrated."""
    error_mm: F64
    limit_mm: F64
    """(N,) MPE; NaN where none is stated."""
    guard_mm: F64
    """(N,) NaN where it is not known."""
    verdict: list[str | None]
    """"pass", "fail", "undecided" or None."""
    a_mm: float | None
    """MPE = a + L / b; None where none is stated."""
    b: float | None


@dataclass(frozen=True)
class Verification:
    """What `ulna verify` found."""

    name: str
    """Of the file."""
    sha256: str
    file: VerificationFile
    remarks: list[Said]
    """Where it is not of this result's arm."""
    lengths: list[TestedLengths]


@dataclass(frozen=True)
class ArtefactRow:
    """An artefact that was touched."""

    name: str
    kind: str
    placements: int
    readings: int
    dimension: str | None
    """"length", "diameter", "features" or None where nothing of it is calibrated or the study is not known."""
    value_mm: float | None
    """Length or diameter."""
    features: int
    """Number of calibrated points."""
    u_mm: float | None
    """Standard uncertainty of length, diameter or (the largest) of a coordinate; 0 where none is stated; None where the
    study is not known."""
    frame: str


@dataclass(frozen=True)
class Environment:
    """Under what circumstances."""

    temperature_c: tuple[float, float, float] | None
    """Lowest, mean and highest of the readings; None where the readings do not say."""
    encoder_rad: list[float] | None
    """Stated standard deviation of each encoder."""
    seat_mm: float | None
    """Stated standard deviation of a touch, per coordinate."""


@dataclass(frozen=True)
class FileRow:
    """A file that the result was made from."""

    path: str
    sha256: str
    rows: int
    state: str
    """"same", "changed", "absent" or "not-compared" (the study was not found)."""


@dataclass(frozen=True)
class ReadFile:
    """A file that the report was made with, besides those of the result."""

    name: str
    sha256: str


@dataclass(frozen=True)
class Provenance:
    """From what, with what and when the result was made."""

    program: str
    version: str
    time: str
    """As the result says it, ISO 8601."""
    seed: int
    study: str | None
    result: str
    """Name of the result file."""
    result_sha256: str
    files: list[FileRow]
    beside: list[ReadFile]
    """Laboratory file, verification, cross-validation, evaluation: those that were given."""
    options: dict[str, Any]
    warnings: list[str]


@dataclass(frozen=True)
class Content:
    """All that a report of a calibration says."""

    arm: str
    joints: int
    probes: list[str]
    fit: FitSummary
    quality: list[QualityRow]
    held_out: list[Said]
    """What the held-out readings are, or that there are none and what would be needed."""
    readings: ReadingRows
    samples: list[Sample]
    clouds: list[Cloud]
    """Over each joint angle, the reach, the temperature; empty where the study is not known."""
    quiver: Quiver | None
    parameters: Parameters
    identification: Identification
    observability: Observability | None
    lengths: Lengths | None
    placements: Sequence[PlacementFigures]
    artefacts: list[ArtefactRow]
    environment: Environment
    outliers: list[dict[str, Any]]
    """As in a result: all of them, the farthest first."""
    extras: list[JudgedExtra]
    verification: Verification | None
    """The acceptance test, where one was given."""
    laboratory: Laboratory | None
    """What the laboratory file says, where one was given."""
    missing: dict[str, Said]
    """Section → what it lacks and what would be needed: "study", "joints", "temperature", "verification", …"""
    provenance: Provenance
