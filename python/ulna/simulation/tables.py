"""The tables of a simulation file, `ulna-simulation/1`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ulna.arm.payload import PayloadTable
from ulna.arm.stated import AmountEach, PositiveEach, TravelTable, VolumeTable
from ulna.artefacts.kinds import SimulatedTable
from ulna.formats.models import Strict
from ulna.formats.numbers import Amount, Positive
from ulna.formats.units import Units
from ulna.study.tables import FittedTable


class DrawingTable(Strict):
    """How far the arm.toml that is written is from the true arm."""

    offset: Amount | None = None
    """Zero offsets are off by up to so much (0.05 rad)."""
    length: Amount | None = None
    """Lengths are, those of the probes too (1 mm)."""
    twist: Amount | None = None
    """Twists are; without it the drawing says the nearest right angle."""
    effects: bool = False
    """Whether it has the true arm's effects beyond geometry."""


def _drawing_kind(drawing: Any) -> str:
    return "<word>" if isinstance(drawing, str) else "<table>"


class NoiseTable(Strict):
    """How readings err; standard deviations."""

    encoder: AmountEach | None = None
    """In the file's angle unit; one number, or one per joint."""
    seat: Amount = 0.0
    """Of a touch, per coordinate, in the file's length unit."""
    counts_per_turn: PositiveEach | None = None
    """Of the encoders, in place of what the arm file says; one number, or one per joint."""
    quantise: bool = True
    """Whether encoders read whole counts, where counts_per_turn is known of all."""


class TemperatureTable(Strict):
    """Of the arm, °C, drawn for each placement; the true arm needs expansion."""

    mean: float
    spread: Amount = 0.0
    """Standard deviation."""


class MissedTable(Strict):
    """Touches with the ball beside its seat, or off the surface."""

    share: Annotated[float, Field(ge=0, le=0.5)]
    """Of all touches."""
    size: Positive
    """How far off the ball is."""


class SimulatedFit(FittedTable):
    """[fit] of the study that is written."""


class SimulationFile(Strict):
    """What to simulate: `ulna-simulation/1`."""

    format: Literal["ulna-simulation/1"]
    arm: str
    """Path of the arm file of the true arm, relative to this file."""
    units: Units
    seed: Annotated[int, Field(ge=0, le=2**63 - 1)] = 0
    drawing: Annotated[
        Annotated[Literal["exact"], Tag("<word>")] | Annotated[DrawingTable, Tag("<table>")],
        Discriminator(_drawing_kind),
    ] = DrawingTable()
    """How far the arm that is written is off; "exact": not at all."""
    noise: NoiseTable = NoiseTable()
    travel: TravelTable | None = None
    temperature: TemperatureTable | None = None
    payload: dict[str, PayloadTable] | None = None
    """What the arm may carry beside its own masses, by name; the true arm needs compliance."""
    carried: str | Annotated[list[str], Field(min_length=1)] | None = None
    """Which of them it carries, "none" for no load: one for all, or several, one of them drawn for each placement."""
    missed: MissedTable | None = None
    volume: VolumeTable | None = None
    artefact: Annotated[dict[str, SimulatedTable], Field(min_length=1)]
    fit: SimulatedFit = SimulatedFit()
