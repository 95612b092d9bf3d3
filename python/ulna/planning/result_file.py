"""`ulna-plan-result/1`, JSON: a plan, as it is written and read again to try it and to check what was measured.

Lengths mm, angles rad unless the key says otherwise, base frame.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from ulna.arm.stated import Box
from ulna.artefacts.kinds import ArtefactTable
from ulna.formats.models import Open
from ulna.formats.numbers import Coordinates
from ulna.planning.spec import PlanSpec
from ulna.planning.stands import Stand
from ulna.simulation.study_files import artefact_table

FORMAT: Literal["ulna-plan-result/1"] = "ulna-plan-result/1"
WHAT = f'a plan.json (format = "{FORMAT}")'


class WithinEntry(Open):
    """Where a person can put the artefact: see `ulna.planning.within.Within`."""

    table_mm: float
    low_mm: float
    high_mm: float
    aside_mm: float


class AskedEntry(Open):
    """What the plan was asked for, as far as trying and checking it need it."""

    artefact: Annotated[dict[str, ArtefactTable], Field(min_length=1, max_length=1)]
    """Its table as in a study file, mm."""
    encoder_rad: list[float]
    seat_mm: float
    touches: Annotated[int, Field(ge=1)]
    hold: list[str]
    probe: str | None
    test_mm: float | None
    volume_mm: Box | None
    travel_rad: list[Annotated[list[float], Field(min_length=2, max_length=2)]] | None
    within: WithinEntry | None
    seed: int


class StandEntry(Open):
    """One place of the artefact."""

    stand: int
    points_mm: Annotated[list[Coordinates], Field(min_length=1)]
    """Where its features (or the touches of a surface) are."""
    lies: str
    """From the first point to the last: level, rising, falling, upright, hanging; nowhere of a single point."""
    azimuth_deg: float
    """Seen from above, from x towards y."""
    slope_deg: float
    placements: Annotated[list[int], Field(min_length=1)]
    """Numbers of its measurements."""


class StepEntry(Open):
    """A row of plan.csv."""

    step: int
    stand: int
    placement: int
    feature: str | None = None
    touch: str | None = None
    """The number of a surface's touch, in place of a feature."""


class CurveEntry(Open):
    """What is expected after so many."""

    measurements: int
    u_length_mm: float
    random_u_length_mm: float


class TrialEntry(Open):
    """What a simulation of it gave."""

    runs: int
    planned_mm: float
    """Length errors of fresh bars, root mean square."""
    random_mm: float
    gain: float


class PlanResultFile(Open):
    """A plan: `ulna-plan-result/1`; figures besides are for readers."""

    format: Literal["ulna-plan-result/1"]
    arm: str
    """Its name; the arm itself is in arm.toml beside this file."""
    asked: AskedEntry
    places: Annotated[list[StandEntry], Field(min_length=1)]
    """Where the artefact stands, in the order of work."""
    planned: dict[str, Any]
    random: dict[str, Any] = Field(default_factory=dict)
    curve: list[CurveEntry] = Field(default_factory=list)
    """Over the number chosen."""
    trial: TrialEntry | None = None
    parameters: int | None = None
    """That are free."""
    determined: int | None = None
    """Directions of them that the candidates determine."""
    candidates: int | None = None
    gain: float | None = None
    steps: Annotated[list[StepEntry], Field(min_length=1)]


def asked_of(spec: PlanSpec) -> dict[str, Any]:
    """`asked`, JSON types only."""
    within = spec.within
    return {
        "artefact": {spec.artefact.name: artefact_table(spec.artefact)},
        "encoder_rad": spec.encoder_rad.tolist(),
        "seat_mm": spec.seat_mm,
        "touches": spec.touches,
        "hold": list(spec.hold),
        "probe": spec.probe,
        "test_mm": spec.test_mm,
        "volume_mm": None if spec.volume_mm is None else [list(corner) for corner in spec.volume_mm],
        "travel_rad": None if spec.travel_rad is None else spec.travel_rad.tolist(),
        "within": None if within is None else dict(vars(within)),
        "seed": spec.seed,
    }


def stand_entry(stand: Stand) -> dict[str, Any]:
    """A stand, JSON types only."""
    return {
        "stand": stand.number,
        "points_mm": stand.points_mm.tolist(),
        "lies": stand.lies,
        "azimuth_deg": stand.azimuth_deg,
        "slope_deg": stand.slope_deg,
        "placements": stand.measurements.tolist(),
    }
