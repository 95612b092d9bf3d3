"""`bar`: two seats a known length apart, features A and B."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact, features_mm
from ulna.artefacts.dimension import Dimension, needs_uncertainty, off_by
from ulna.artefacts.entering import enter_points
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.artefacts.readings import InputFile, Readings
from ulna.artefacts.seats import Seats
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching, touched_features
from ulna.formats.numbers import Positive, Uncertainty
from ulna.formats.wording import rows_named
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


class BarTable(StatedTable):
    """Two seats a known length apart: features A and B."""

    kind: Literal["bar"]
    length: Positive
    u: Uncertainty = 0.0
    """Standard uncertainty of the length."""
    fit: bool = False
    """Whether the length may change within its uncertainty; else it stays, and its uncertainty counts."""

    def made(self, name: str, place: Place) -> Artefact:
        """With its seats on the x axis."""
        needs_uncertainty(name, self.fit, self.u, place.path)
        length_mm = self.length * place.units.mm
        return _with_ends(Artefact(name, "bar", {}, length_mm, self.u * place.units.mm, fitted=self.fit))


class SimulatedBar(BarTable, TouchedTable):
    """A bar, and how it is touched."""


def _with_ends(bar: Artefact) -> Artefact:
    return replace(bar, features={"A": (0.0, 0.0, 0.0), "B": (bar.length_mm or 0.0, 0.0, 0.0)})


class Bar(Kind):
    """Two seats a known length apart."""

    name = "bar"
    lent = "length"
    table, simulated = BarTable, SimulatedBar
    named, scattered, indivisible = True, False, True
    residual_columns = ("feature", "x_mm", "y_mm", "z_mm")
    placements = 100

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """Its length."""
        return [Dimension("length", artefact.length_mm or 0.0, artefact.u_mm, artefact.fitted)]

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """As two points, of which the distance is uncertain."""
        artefact = group.artefact
        assert artefact.length_mm is not None
        length = ("length", artefact.length_mm, artefact.u_mm, artefact.fitted)
        enter_points(problem, group, conditions[0], dimensions=[length])

    def check_readings(self, group: Readings, files: Sequence[InputFile], study: Path) -> None:
        """A placement of a bar tells a length only where both of its seats were touched. Raises UlnaInputError."""
        code = group.placement_code
        names = list(group.artefact.features)
        touched = [np.bincount(code[group.feature == k], minlength=code.max() + 1) for k in range(len(names))]
        for k, name in enumerate(names):
            without = np.flatnonzero(touched[k] == 0)
            if not len(without):
                continue
            rows = np.flatnonzero(code == without[0])
            more = f" (and {len(without) - 1} more such placements)" if len(without) > 1 else ""
            raise UlnaInputError(
                f"{study}: artefact '{group.artefact.name}', placement '{group.placement[rows[0]]}'{more}: feature "
                f"'{name}' was never touched, only '{names[1 - k]}' ({rows_named(group.row[rows])} of "
                f"{files[group.file[rows[0]]].path}); expected readings at both ends of a bar. Touch the other end "
                "too, remove these rows, or declare a seat for them."
            )

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Scatter in the seats, and the length."""
        return Seats.of(readings, tips).found(lengths=True)

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Longer or shorter."""
        return _with_ends(off_by(stated, "length_mm", rng))

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """Both ends."""
        return touched_features(features_mm(true), how)

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """Its length."""
        return {"length": artefact.length_mm}
