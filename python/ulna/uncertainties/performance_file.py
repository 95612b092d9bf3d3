"""Performance files: `ulna-performance/1`, TOML: what a certificate says of an arm whose calibration is not at hand."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from ulna.arm.arm import Arm
from ulna.arm.stated import PositiveEach, TravelTable, encoder_of, travel_of
from ulna.formats.models import Strict, check_kind, fill
from ulna.formats.numbers import Positive, Uncertainty
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.study.readings.checks import named_probe
from ulna.uncertainties.performance import Figure, LengthTest, Performance, PointTest, SphereTest, Test

WHAT = 'a performance file (TOML, format = "ulna-performance/1")'

Few = Annotated[int, Field(ge=1, le=1000)]


class SpreadTable(Strict):
    """How far arms of this make are from their drawing before the certificate is looked at, standard deviations. Only
    the proportion matters: a common factor is drawn as well."""

    angle: Positive
    """Zero offsets, twists."""
    length: Positive
    """Links, tip."""
    factor: Annotated[list[Positive], Field(min_length=2, max_length=2)] = Field(default_factory=lambda: [0.01, 100.0])
    """Least and largest factor; uniform in its logarithm between them."""
    hold: list[str] = Field(default_factory=list)
    """Parameters that are as drawn: shell-style patterns."""


class PerformanceNoise(Strict):
    """Standard deviations of readings, in the test and afterwards."""

    encoder: PositiveEach
    """In the file's angle unit; one number, or one per joint."""
    seat: Uncertainty = 0.0
    """Of a touch, per coordinate, in the file's length unit."""


class PointTable(Strict):
    """A seat touched in many postures (single-point articulation)."""

    kind: Literal["point"]
    positions: Annotated[list[Annotated[float, Field(gt=0, le=1)]], Field(min_length=1)] = Field(
        default_factory=lambda: [0.2, 0.5, 0.8]
    )
    """Distances of the seats from the base, in parts of the reach."""
    touches: Annotated[int, Field(ge=2, le=1000)] = 10
    largest: Positive | None = None
    """What the certificate says: largest distance of a touch from the mean of its seat."""
    two_s: Positive | None = None
    """What the certificate says: 2·S, S = √(Σδ²/(n−1)), of the worst seat."""
    half_range: Positive | None = None
    """What the certificate says: (max − min)/2 of the worst coordinate at the worst seat."""


class LengthTable(Strict):
    """Known lengths in many places."""

    kind: Literal["length"]
    lengths: Annotated[list[Positive], Field(min_length=1)]
    places: Few = 20
    """Of each."""
    largest: Positive | None = None
    """What the certificate says: largest error of a length, without its sign."""
    two_sigma: Positive | None = None
    """What the certificate says: twice the standard deviation of the errors."""
    half_range: Positive | None = None
    """What the certificate says: (max − min)/2 of the errors."""


class SphereTable(Strict):
    """A calibrated ball, touched at many points over one half of it."""

    kind: Literal["sphere"]
    diameter: Positive
    positions: Few = 2
    touches: Annotated[int, Field(ge=5, le=1000)] = 25
    form: Positive | None = None
    """What the certificate says: largest less smallest distance from the fitted centre, at the worst position."""
    size: Positive | None = None
    """What the certificate says: largest error of the diameter, without its sign."""


def _kind(table: object) -> str:
    return f"<{table.get('kind') if isinstance(table, dict) else getattr(table, 'kind', None)}>"


TestTable = Annotated[
    Annotated[PointTable, Tag("<point>")]
    | Annotated[LengthTable, Tag("<length>")]
    | Annotated[SphereTable, Tag("<sphere>")],
    Discriminator(_kind),
]


class PerformanceFile(Strict):
    """An arm known by its performance test alone."""

    format: Literal["ulna-performance/1"]
    units: Units
    probe: str | None = None
    """The probe of the test, where the arm has several."""
    spread: SpreadTable
    noise: PerformanceNoise
    test: Annotated[list[TestTable], Field(min_length=1)]
    within: Annotated[float, Field(gt=0, lt=1)] = 0.2
    """How near a simulated figure must come to the certificate's, as a part of it."""
    at_most: bool = False
    """Whether the certificate states limits that were kept, not figures that were found."""
    travel: TravelTable | None = None
    """How far joints turn, where the arm has no limits or they shall turn less."""


@dataclass(frozen=True)
class StatedPerformance:
    """The same in rad and mm."""

    performance: Performance
    travel_rad: F64 | None
    """(n, 2); None: the arm's limits."""


def read_performance(path: Path, arm: Arm) -> StatedPerformance:
    """Raises UlnaInputError."""
    document, _ = read_toml(path, WHAT)
    check_format(document, path, "ulna-performance")
    for number, table in enumerate(document.get("test", []) if isinstance(document.get("test"), list) else [], 1):
        check_kind(table, f"test.{number}", ("point", "length", "sphere"), path)
    file = fill(PerformanceFile, document, path)
    low, high = file.spread.factor
    if not low < high:
        raise UlnaInputError(
            f"{path}: key 'spread.factor': got {file.spread.factor}, expected the lower number first. Swap them."
        )
    units = file.units
    performance = Performance(
        label=str(path),
        probe=named_probe(file.probe, arm, path),
        spread_rad=file.spread.angle * units.rad,
        spread_mm=file.spread.length * units.mm,
        factor=(low, high),
        hold=tuple(file.spread.hold),
        encoder_rad=encoder_of(file.noise.encoder, arm, units, path),
        seat_mm=file.noise.seat * units.mm,
        tests=tuple(_test(table, number, units.mm, path) for number, table in enumerate(file.test, 1)),
        within=file.within,
        at_most=file.at_most,
    )
    return StatedPerformance(performance, travel_of(file.travel, arm, units, path))


def _test(table: PointTable | LengthTable | SphereTable, number: int, mm: float, path: Path) -> Test:
    known: dict[Figure, float] = {}
    names: tuple[Figure, ...] = ("largest", "two_s", "two_sigma", "half_range", "form", "size")
    for name in names:
        value = getattr(table, name, None)
        if value is not None:
            known[name] = value * mm
    if not known:
        fields = [name for name in names if name in type(table).model_fields]
        raise UlnaInputError(
            f"{path}: key 'test.{number}': the certificate's figure is missing; expected one or more of "
            f"{', '.join(fields)}. Add what the certificate says."
        )
    if isinstance(table, PointTable):
        return PointTest(known, tuple(table.positions), table.touches)
    if isinstance(table, LengthTable):
        return LengthTest(known, tuple(length * mm for length in table.lengths), table.places)
    return SphereTest(known, table.diameter * mm, table.positions, table.touches)
