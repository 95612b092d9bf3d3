"""`plane`: a flat touched on its surface; its place is unknown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.dimension import Dimension
from ulna.artefacts.entering import enter_surface
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.readings import Readings
from ulna.artefacts.surface import PLASTIC, Surface, check_known, of_placements
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching
from ulna.formats.numbers import Positive
from ulna.ground.arrays import F64

FEWEST = 4
"""Touches that leave something to judge: one more than a plane can meet."""


class PlaneTable(StatedTable):
    """A flat touched on its surface; its place is unknown."""

    kind: Literal["plane"]

    def made(self, name: str, place: Place) -> Artefact:
        """Nothing of it is stated."""
        return Artefact(name, "plane", {})


class SimulatedPlane(PlaneTable, TouchedTable):
    """A plane, and how it is touched: over a rectangle."""

    size: Annotated[list[Positive], Field(min_length=2, max_length=2)] | None = None
    """Sides of the rectangle (200 mm by 200 mm)."""

    def size_mm(self, mm: float) -> tuple[float, float] | None:
        """Of the rectangle."""
        return None if self.size is None else (self.size[0] * mm, self.size[1] * mm)


class Plane(Surface):
    """A flat."""

    name = "plane"
    table, simulated = PlaneTable, SimulatedPlane

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """None."""
        return []

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With the probes' balls."""
        enter_surface(problem, "plane", group, balls_mm, conditions[0])

    def check_probes(self, artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
        """A plane touched with one probe does not need its ball: it lies by half of it farther in, that is all. With
        several the balls are known. Raises UlnaInputError."""
        if len(used) > 1:
            check_known(artefact, arm, used, label)

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Form: largest minus smallest distance from the least-squares plane of each placement."""
        return of_placements(tips, FEWEST, lambda centre_mm, ball_mm: [form_mm(centre_mm, ball_mm)], ("form",))

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """A plane is a plane."""
        return stated

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """A rectangle about the origin, evenly."""
        number = np.tile(np.arange(how.touches), len(how.probes)) + 1.0
        x, y = ((0.5 + number / PLASTIC**power) % 1.0 - 0.5 for power in (1, 2))
        width_mm, height_mm = how.size_mm
        probe = np.repeat(how.probes, how.touches)
        centre_mm = np.column_stack([width_mm * x, height_mm * y, 0.5 * how.balls_mm[probe]])
        return Touches(centre_mm, np.tile([0.0, 0.0, 1.0], (len(probe), 1)), probe, np.zeros(len(probe), np.int64))


def form_mm(centre_mm: F64, ball_mm: F64) -> float:
    """Largest minus smallest distance from the least-squares plane of ball centres (N, 3) of diameters (N,), mm.

    The normal is the direction in which the centres scatter least.
    """
    p = centre_mm - centre_mm.mean(axis=0)
    normal = np.linalg.svd(p, full_matrices=False)[2][2]
    if np.ptp(ball_mm) == 0.0:
        return float(np.ptp(p @ normal))
    # balls of several sizes: their radii are taken off on the side that the plane is touched from
    return min(_form_on_one_side(p, side, 0.5 * ball_mm) for side in (normal, -normal))


def _form_on_one_side(p: F64, normal: F64, radius_mm: F64) -> float:
    """The same for one side, by Gauss–Newton on the normal's tilt and the distance."""
    off = p @ normal - radius_mm
    for _ in range(20):
        along = np.linalg.svd(normal[np.newaxis])[2][1:]
        columns = np.column_stack([p @ along.T, -np.ones(len(p))])
        step = np.linalg.lstsq(columns, -off, rcond=None)[0]
        normal = normal + step[:2] @ along
        normal /= np.linalg.norm(normal)
        off = p @ normal - radius_mm
        off -= off.mean()
        if np.abs(step[:2]).max() <= 1e-14:
            break
    return float(np.ptp(off))
