"""Plans: what is touched and what for; and what planning found."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.files import FileInfo
from ulna.serve.contract.model import Asked, Name, Said, Sentence, Sha256, Value

Positive = Annotated[float, Field(gt=0, le=1e6)]
Amount = Annotated[float, Field(ge=0, le=1e6)]
Three = Annotated[list[float], Field(min_length=3, max_length=3)]


class FeatureAsked(Asked):
    """A point of an artefact, in its own frame."""

    name: Name
    point_mm: Three


class ArtefactAsked(Asked):
    """What is touched: as the record has it, or as it is stated here."""

    record: Name | None = None
    """Its name in the record: its size is what its certificate says."""
    expired_because: Annotated[str, Field(min_length=3, max_length=500)] | None = None
    """Why it is used although its certificate has run out."""
    name: Name | None = None
    """None: the record's, else its kind."""
    kind: Name | None = None
    """bar, seat (a cone), points, sphere, plane, …; None: as what the record has is certified."""
    length_mm: Positive | None = None
    diameter_mm: Positive | None = None
    u_mm: Amount | None = None
    """Standard uncertainty."""
    features: Annotated[list[FeatureAsked], Field(max_length=1000)] | None = None


class PlanAsked(Asked):
    """A plan file to be made; None: as `ulna plan --make-plan` fills it in."""

    arm: Sha256
    artefact: ArtefactAsked
    name: Name = "plan.toml"
    test_length_mm: Positive | None = None
    encoder_rad: Annotated[list[Amount], Field(min_length=1, max_length=16)] | None = None
    """Standard deviation of each encoder, or one of all."""
    seat_mm: Amount | None = None
    """Of a touch."""
    travel_deg: (
        Annotated[list[Annotated[list[float], Field(min_length=2, max_length=2)]], Field(min_length=1, max_length=16)]
        | None
    ) = None
    """How far each joint turns, lowest and highest, or one pair for all; None: as the arm file says."""
    measurements: Annotated[int, Field(ge=1, le=10_000)] = 100
    places: Annotated[int, Field(ge=1, le=10_000)] = 12
    """Of the artefact, at the most."""
    touches: Annotated[int, Field(ge=1, le=100)] | None = None
    """Of each feature in a measurement."""
    probe: Name | None = None
    trials: Annotated[int, Field(ge=0, le=10_000)] | None = None
    """Calibrations that are simulated to see what the plan gains."""


class PlanInfo(Said):
    """A plan file, as it is understood for an arm."""

    file: FileInfo
    artefact: str
    kind: str
    stated: str
    """What is stated of the artefact: "443.172 mm, u 0.001 mm"."""
    features: list[str]
    test_length: Value | None
    encoder_rad: list[float]
    seat: Value
    travel_deg: list[tuple[float, float]] | None
    measurements: int
    places: int | None
    touches: int
    probe: str | None
    text: str
    """The file: what stands behind '#' is to be looked at."""


class Place(Said):
    """Where the artefact is put."""

    number: int
    """In the order of work."""
    points_mm: list[tuple[float, float, float]]
    """Of its features."""
    lies: str
    """level, rising, falling, upright, hanging, nowhere."""
    slope_deg: float
    azimuth_deg: float
    measurements: list[int]


class Step(Said):
    """One touch, in the order of work."""

    number: int
    place: int
    measurement: int
    feature: str
    q_deg: list[float]


class Expected(Said):
    """What a length is worth after so many measurements, U (k = 2)."""

    measurements: int
    planned: Value
    random: Value


class Gain(Said):
    """A figure of the plan beside the same of random measurements."""

    figure: Literal["length", "length-worst", "point", "simulated"]
    planned: Value
    random: Value


class PlanOutcome(Said):
    """What planning found."""

    sha256: Sha256
    arm: str
    artefact: str
    places: list[Place]
    steps: list[Step]
    expected: list[Expected]
    gains: list[Gain]
    """U (k = 2); `simulated` is a root mean square of errors."""
    gain: float | None
    """By which part the expected U is smaller than that of random measurements."""
    determined: int | None
    parameters: int | None
    candidates: int | None
    sentences: list[Sentence]
