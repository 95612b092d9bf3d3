"""What a plan is asked for. Units are mm and rad, always."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ulna.arm.stated import Box
from ulna.artefacts.artefact import Artefact
from ulna.ground.arrays import F64
from ulna.planning.within import Within
from ulna.study.study import Study

Criterion = Literal["D", "A", "E", "G", "length", "length-worst", "point"]


@dataclass(frozen=True)
class PlanSpec:
    """An artefact, how many measurements of it to take, and what they are to be good for."""

    artefact: Artefact
    """A bar, a seat, points, a sphere or a plane. One measurement touches all of its features, or a half of the sphere,
    or 200 mm by 200 mm of the plane."""
    encoder_rad: F64
    """(n,) standard deviation of each encoder."""
    seat_mm: float
    """Of a touch, per coordinate."""
    choose: int = 100
    """Measurements to choose."""
    touches: int = 1
    """Of each feature in a measurement, each in another posture; of a sphere or plane: in all."""
    placements: int | None = None
    """Most places in which the artefact may stand; None: as many as are worth it."""
    candidates: int = 100_000
    """Measurements to choose from."""
    criterion: Criterion = "length"
    """D, A, E, G: of the parameters. length, length-worst: the mean or the largest variance of test lengths in
    `volume_mm`. point: the mean variance of test points in it, after the best rigid motion."""
    hold: list[str] = field(default_factory=list)
    """Parameters that will not be fitted: shell-style patterns."""
    probe: str | None = None
    """None: the arm's only one."""
    taken: Study | None = None
    """Readings that were taken already, which the plan completes."""
    known_length_mm: float = 1.0
    """By how much lengths of the arm may be off that touching begins with: a standard deviation."""
    known_angle_rad: float = 0.01
    """The same of its angles."""
    test_mm: float | None = None
    """Length of the test bars; None: the largest distance between features, of a seat half the arm's reach."""
    travel_rad: F64 | None = None
    """(n, 2) lowest and highest encoder angle, in place of the arm's own limits."""
    volume_mm: Box | None = None
    """Corners of the box in which lengths and points will be measured; None: all that the arm reaches."""
    room_mm: Box | None = None
    """Corners of the box in which the artefact may stand; None: all that the arm reaches."""
    within: Within | None = field(default_factory=Within)
    """What the table, the base and a person's reach leave; None: all that the arm reaches."""
    trials: int = 200
    """Calibrations on the plan, and as many on random measurements, that show by simulation what it gains; 0: none."""
    seed: int = 0
    label: str = "plan"
    """How messages call it."""
    files: tuple[Path, ...] = ()
    """Files that it was read from, which no output may replace."""
