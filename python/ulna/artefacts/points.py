"""`points`: features with calibrated coordinates: ball bar, ball plate, points from a laser tracker."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact, features_mm
from ulna.artefacts.dimension import Dimension, needs_uncertainty
from ulna.artefacts.entering import enter_points
from ulna.artefacts.features import features_of_file
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.artefacts.readings import Readings
from ulna.artefacts.seats import Seats
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching, touched_features
from ulna.formats.layout import TableKeys
from ulna.formats.names import check_name
from ulna.formats.numbers import Coordinates, Uncertainty
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


def _features_kind(features: Any) -> str:
    return "<file>" if isinstance(features, str) else "<table>"


Features = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[Annotated[dict[str, Coordinates], Field(min_length=1)], Tag("<table>")],
    Discriminator(_features_kind),
]


class PointsTable(StatedTable):
    """Features with calibrated coordinates: ball bar, ball plate, points from a laser tracker."""

    kind: Literal["points"]
    features: Features | None = None
    """Coordinates by name, or the path of a table with columns feature, x, y, z and perhaps u; left out where every
    reading brings the coordinates of a point of its own, in columns x, y, z and perhaps u."""
    features_format: TableKeys | None = None
    """How the table of features is written, where it is not a CSV file with commas."""
    frame: Literal["free", "arm"] = "free"
    """"arm": the coordinates are in the arm's base frame; "free": each placement stands at an unknown pose."""
    u: Uncertainty | None = None
    """Standard uncertainty of each coordinate."""
    fit: bool = False
    """Whether features may move within their uncertainty; else they stay, and it counts."""

    def made(self, name: str, place: Place) -> Artefact:
        """Without features where every reading brings a point of its own (`ulna.study.readings.own_points`)."""
        mm, path = place.units.mm, place.path
        if self.features_format is not None and not isinstance(self.features, str):
            raise UlnaInputError(
                f"{path}: key 'artefact.{name}.features_format': says how a file is written, but the key 'features' "
                "names none. Remove it, or name the file of the features."
            )
        plain = Artefact(name, "points", {}, None, (self.u or 0.0) * mm, self.frame, fitted=self.fit)
        if isinstance(self.features, str):
            return self._of_file(plain, place)
        if isinstance(self.features, dict):
            needs_uncertainty(name, self.fit, self.u, path)
            for feature in self.features:
                check_name(feature, f"artefact.{name}.features.{feature}", path)
            features = {key: (x * mm, y * mm, z * mm) for key, (x, y, z) in self.features.items()}
            return replace(plain, features=features)
        return plain

    def _of_file(self, plain: Artefact, place: Place) -> Artefact:
        assert isinstance(self.features, str)
        file = place.path.parent / self.features
        key = f"artefact.{plain.name}"
        found = features_of_file(file, self.features_format, key, place)
        if found.u_mm is not None and self.u is not None:
            raise UlnaInputError(
                f"{place.path}: key '{key}.u': got {self.u:g}, but {file} has a column 'u' as well. Remove one of them."
            )
        if self.fit and not (plain.u_mm or (found.u_mm and any(found.u_mm))):
            raise UlnaInputError(
                f"{place.path}: key '{key}.fit': true, but neither the key 'u' nor a column 'u' of {file} says how "
                "uncertain its features are; expected the standard uncertainty that they may move within. Add it, or "
                "remove the key."
            )
        return replace(plain, features=found.features_mm, feature_u_mm=found.u_mm)


class SimulatedPoints(PointsTable, TouchedTable):
    """Points, and how they are touched."""


def _u_mm(artefact: Artefact) -> F64:
    return np.array(artefact.feature_u_mm or [artefact.u_mm] * len(artefact.features))


class Points(Kind):
    """Features with calibrated coordinates."""

    name = "points"
    table, simulated = PointsTable, SimulatedPoints
    named, scattered = True, False
    residual_columns = ("feature", "x_mm", "y_mm", "z_mm")
    features_file = True

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """None that is one number: each coordinate is uncertain by itself."""
        return []

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With the uncertainty of every feature."""
        artefact = group.artefact
        enter_points(problem, group, conditions[0], feature_u_mm=_u_mm(artefact), features_fitted=artefact.fitted)

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Scatter in the seats; lengths between them, where they stand free; coordinates."""
        seats = Seats.of(readings, tips)
        found = seats.found(lengths=readings.artefact.frame == "free")
        coordinates = seats.coordinate_errors(readings, tips)
        return found if coordinates is None else found | {"coordinate_error": coordinates}

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Every coordinate by itself."""
        u_mm = _u_mm(stated)
        points_mm = features_mm(stated) + u_mm[:, None] * rng.standard_normal((len(u_mm), 3))
        named = zip(stated.features, points_mm.tolist(), strict=True)
        return replace(stated, features={name: (x, y, z) for name, (x, y, z) in named})

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """Every feature."""
        return touched_features(features_mm(true), how)

    def check_simulated(self, table: TouchedTable, key: str) -> None:
        """There are features to touch; in the arm's frame they stand in one place. Raises UlnaInputError."""
        assert isinstance(table, SimulatedPoints)
        if table.features is None:
            raise UlnaInputError(f"{key}.features' is missing; a simulation needs to know what is touched. Add it.")
        if table.frame == "arm" and (table.placements or 1) != 1:
            raise UlnaInputError(
                f"{key}.placements': got {table.placements}, but its coordinates are in the arm's frame: it stands in "
                "one place. Remove the key, or give touches."
            )

    def check_planned(self, artefact: Artefact, touches: int, label: str) -> None:
        """There are features to touch. Raises UlnaInputError."""
        if not artefact.features:
            raise UlnaInputError(
                f"{label}: key 'artefact.{artefact.name}.features' is missing; a plan needs to know what is touched. "
                "Add it."
            )

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """Where its features are, and in which frame."""
        return {"features": features_file, "frame": artefact.frame}
