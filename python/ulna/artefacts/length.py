"""`length`: rows that give two poses of the arm and the distance between their tips."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.dimension import Dimension, needs_uncertainty, off_by
from ulna.artefacts.entering import enter_rows
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.artefacts.readings import Readings
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching, touched_features
from ulna.formats.numbers import Positive, Uncertainty
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


class LengthTable(StatedTable):
    """Rows that give two poses of the arm and the distance between their tips."""

    kind: Literal["length"]
    length: Positive | None = None
    """Fills the column `length` where the file has none."""
    u: Uncertainty = 0.0
    """Standard uncertainty of each length, common to all of them."""
    fit: bool = False
    """Whether all lengths may change by one amount within it."""

    def made(self, name: str, place: Place) -> Artefact:
        """Without features: a row touches nothing that stands anywhere."""
        needs_uncertainty(name, self.fit, self.u, place.path)
        distance_mm = None if self.length is None else self.length * place.units.mm
        return Artefact(name, "length", {}, distance_mm, self.u * place.units.mm, fitted=self.fit)


class SimulatedLength(LengthTable, TouchedTable):
    """Pairs of poses a known length apart, and how many."""


class Length(Kind):
    """Two poses and the distance between their tips."""

    name = "length"
    table, simulated = LengthTable, SimulatedLength
    poses, named, scattered = 2, False, False
    measured_column = "length"
    residual_columns = ("length_mm",)
    placements = 100

    def placed(self, artefact: Artefact) -> bool:
        """Every row by itself."""
        return False

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """What all lengths have in common, where there is one."""
        return [Dimension("length", artefact.length_mm or 0.0, artefact.u_mm, artefact.fitted)]

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """As rows of two poses and a length."""
        assert group.p_rad is not None
        assert group.length_mm is not None
        artefact, (first, second) = group.artefact, conditions
        # what is uncertain is common to all lengths: told by that of the first
        uncertain = [("length", float(group.length_mm[0]), artefact.u_mm, artefact.fitted)] if len(group) else []
        enter_rows(
            problem,
            "length",
            group,
            first,
            p_rad=np.ascontiguousarray(group.p_rad),
            p_approach=second.get("approach"),
            measured_mm=group.length_mm,
            dimensions=uncertain,
        )

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """The distance between the two tips minus the stated one."""
        assert tips.second_mm is not None
        assert readings.length_mm is not None
        distance_mm = np.linalg.norm(tips.second_mm - tips.first_mm, axis=1)
        return {"length_error": Errors(distance_mm - readings.length_mm, tips.code)}

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Longer or shorter."""
        return off_by(stated, "length_mm", rng)

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """Both ends, once."""
        return touched_features(np.array([[0.0, 0.0, 0.0], [true.length_mm or 0.0, 0.0, 0.0]]), how)

    def measured_mm(
        self, stated: Artefact, true: Artefact, touches: Touches, places: int, rng: np.random.Generator
    ) -> F64 | None:
        """Nobody measures it: it is what is stated."""
        return np.full(places, stated.length_mm or 0.0)

    def check_simulated(self, table: TouchedTable, key: str) -> None:
        """The length is known, and a row is two poses with one probe. Raises UlnaInputError."""
        assert isinstance(table, SimulatedLength)
        if table.length is None:
            raise UlnaInputError(f"{key}.length' is missing; a simulation needs to know what is touched. Add it.")
        if (table.touches or 1) != 1:
            raise UlnaInputError(
                f"{key}.touches': got {table.touches}, but a row of lengths is two poses; expected 1. Remove the key, "
                "and give placements: the number of rows."
            )
        if isinstance(table.probe, list) and len(table.probe) > 1:
            raise UlnaInputError(f"{key}.probe': got {len(table.probe)} probes; expected one. Correct it.")

    def check_planned(self, artefact: Artefact, touches: int, label: str) -> None:
        """A plan is made of what can be set up. Raises UlnaInputError."""
        raise UlnaInputError(
            f"{label}: artefact '{artefact.name}' is a length, which nobody can set up; expected an artefact that is "
            "touched. State the bar whose length it is."
        )

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """The length of all rows, where there is one."""
        return {} if artefact.length_mm is None else {"length": artefact.length_mm}
