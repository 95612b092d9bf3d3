"""Plan files: `ulna-plan/1`, TOML: what to choose measurements of, and what they are to be good for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ulna.arm.arm import Arm
from ulna.arm.stated import PositiveEach, TravelTable, VolumeTable, encoder_of, travel_of, volume_of
from ulna.artefacts.kinds import ArtefactTable, check_kinds, kind_of, made
from ulna.artefacts.tables import Place
from ulna.formats.models import Strict, fill
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError
from ulna.planning.spec import Criterion, PlanSpec
from ulna.planning.within import Within
from ulna.study.data import FitOptions
from ulna.study.study import Study

WHAT = 'a plan file (TOML, format = "ulna-plan/1")'

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(ge=1, le=1_000_000)]


class PlanNoise(Strict):
    """Standard deviations of the readings to come."""

    encoder: PositiveEach
    """In the file's angle unit; one number, or one per joint."""
    seat: Annotated[float, Field(ge=0)] = 0.0
    """Of a touch, per coordinate, in the file's length unit."""


class PlanTable(Strict):
    """How many to choose, and by what."""

    choose: Count = 100
    """Measurements; each touches every feature of the artefact."""
    touches: Annotated[int, Field(ge=1, le=100)] | None = None
    """Of each feature in a measurement (1); of a sphere or plane: in all (20)."""
    placements: Count | None = None
    """Most places in which the artefact may stand."""
    candidates: Count | None = None
    """100 000; of a sphere or plane 10 000."""
    criterion: Criterion = "length"
    hold: list[str] = Field(default_factory=list)
    """Parameters that will not be fitted: shell-style patterns."""
    probe: str | None = None
    taken: str | None = None
    """Path of a study whose readings the plan completes, relative to this file."""
    known_length: Positive | None = None
    """By how much lengths of the arm file may be off (1 mm), a standard deviation; for `ulna live touch`."""
    known_angle: Positive | None = None
    """The same of angles (0.01 rad)."""
    test_length: Positive | None = None
    """Of the bars for which length uncertainty is judged."""
    trials: Annotated[int, Field(ge=0, le=100_000)] = 200
    """Calibrations simulated on the plan, and as many on random measurements."""
    seed: Annotated[int, Field(ge=0, le=2**62)] = 0


class WithinTable(Strict):
    """Where a person can put the artefact, in the file's length unit."""

    table: float | None = None
    """z of the table that the base stands on, in the base frame (0)."""
    low: float | None = None
    """Lowest height of a feature above the table (0)."""
    high: float | None = None
    """Highest (1000 mm)."""
    aside: Annotated[float, Field(ge=0)] | None = None
    """Nothing is nearer to the base's z axis (150 mm)."""


def _within_kind(within: Any) -> str:
    return "<word>" if isinstance(within, str) else "<table>"


class PlanFile(Strict):
    """What to plan: `ulna-plan/1`."""

    format: Literal["ulna-plan/1"]
    units: Units
    artefact: Annotated[dict[str, ArtefactTable], Field(min_length=1, max_length=1)]
    """One: a bar, a seat, points, a sphere or a plane."""
    noise: PlanNoise
    plan: PlanTable = PlanTable()
    travel: TravelTable | None = None
    """How far joints turn, where the arm file has no limits or they shall turn less."""
    volume: VolumeTable | None = None
    """Where lengths and points will be measured."""
    room: VolumeTable | None = None
    """Where the artefact may stand; stated, it takes the place of `within`."""
    within: (
        Annotated[
            Annotated[Literal["reach"], Tag("<word>")] | Annotated[WithinTable, Tag("<table>")],
            Discriminator(_within_kind),
        ]
        | None
    ) = None
    """What the table, the base and a person's reach leave; "reach": all that the arm reaches."""


def load_plan_spec(path: Path, arm: Arm) -> PlanSpec:
    """Read what to plan for an arm. Raises UlnaInputError."""
    document, _ = read_toml(path, WHAT)
    check_format(document, path, "ulna-plan")
    check_kinds(document, path)
    file = fill(PlanFile, document, path)
    units, table = file.units, file.plan
    ((name, artefact_table),) = file.artefact.items()
    place = Place(path, units, [])
    artefact = made(name, artefact_table, place)
    kind = kind_of(artefact)
    study = None if table.taken is None else Study.load(path.parent / table.taken)
    files = [path, *(each.path for each in place.files)]
    files += [] if study is None else [file.path for file in study.files]
    usual = FitOptions()
    return PlanSpec(
        artefact=artefact,
        encoder_rad=encoder_of(file.noise.encoder, arm, units, path),
        seat_mm=file.noise.seat * units.mm,
        choose=table.choose,
        touches=table.touches or (kind.touches if kind.scattered else 1),
        placements=table.placements,
        candidates=table.candidates or (10_000 if kind.scattered else 100_000),
        criterion=table.criterion,
        hold=list(table.hold),
        probe=table.probe,
        taken=study,
        known_length_mm=usual.known_length_mm if table.known_length is None else table.known_length * units.mm,
        known_angle_rad=usual.known_angle_rad if table.known_angle is None else table.known_angle * units.rad,
        test_mm=None if table.test_length is None else table.test_length * units.mm,
        travel_rad=travel_of(file.travel, arm, units, path),
        volume_mm=volume_of(file.volume, units, path),
        room_mm=volume_of(file.room, units, path, "room"),
        within=_within(file, path),
        trials=table.trials,
        seed=table.seed,
        label=str(path),
        files=tuple(files),
    )


def _within(file: PlanFile, path: Path) -> Within | None:
    """As stated, else what is usual unless there is a room. Raises UlnaInputError."""
    table = file.within
    if isinstance(table, str) or (table is None and file.room is not None):
        return None
    stated = {} if table is None else table.model_dump(exclude_none=True)
    within = Within(**{f"{key}_mm": value * file.units.mm for key, value in stated.items()})
    if not within.low_mm < within.high_mm:
        raise UlnaInputError(
            f"{path}: key 'within': heights above the table from {within.low_mm:g} mm to {within.high_mm:g} mm; "
            "expected low below high. Correct one of them."
        )
    return within
