"""`seat`: one cone or socket whose place is unknown, the feature `seat`."""

from __future__ import annotations

from typing import Literal

import numpy as np

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact, features_mm
from ulna.artefacts.dimension import Dimension
from ulna.artefacts.entering import enter_points
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.artefacts.readings import Readings
from ulna.artefacts.seats import Seats
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching, touched_features
from ulna.ground.arrays import F64


class SeatTable(StatedTable):
    """One cone or socket whose place is unknown: the feature `seat`."""

    kind: Literal["seat"]

    def made(self, name: str, place: Place) -> Artefact:
        """One point at the origin of its own frame."""
        return Artefact(name, "seat", {"seat": (0.0, 0.0, 0.0)})


class SimulatedSeat(SeatTable, TouchedTable):
    """A seat, and how it is touched."""


class Seat(Kind):
    """One cone or socket."""

    name = "seat"
    table, simulated = SeatTable, SimulatedSeat
    named, scattered = True, False
    residual_columns = ("feature", "x_mm", "y_mm", "z_mm")
    placements, touches = 1, 30

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """None: only where it is, nobody knows."""
        return []

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """As one point."""
        enter_points(problem, group, conditions[0])

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Scatter in the seat."""
        return Seats.of(readings, tips).found(lengths=False)

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Nothing of it is stated, so nothing is off."""
        return stated

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """The seat, again and again."""
        return touched_features(features_mm(true), how)
