"""`distance`: from an unknown fixed point to the tip, a row each: a draw wire, a telescoping bar, a laser tracer."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.dimension import Dimension
from ulna.artefacts.entering import enter_rows
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.artefacts.readings import Readings
from ulna.artefacts.surface import GOLDEN, PLASTIC
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching
from ulna.formats.numbers import Positive, Uncertainty
from ulna.geometry.point import fit_point
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError

FEWEST = 5
"""Rows that leave something to judge: four tell a point from its mirror image, one more is left."""

MOST_STEPS = 30
STILL = 1e-13
"""Of an offset in mm or a scale: a step this small is none."""


RIGHT = Dimension("offset", 0.0, 0.0, False), Dimension("scale", 1.0, 0.0, False, "1")
"""Of an instrument that is."""


@dataclass(frozen=True)
class Instrument:
    """What is stated of what measures: distance = offset + scale · reading."""

    offset: Dimension = RIGHT[0]
    scale: Dimension = RIGHT[1]

    @property
    def dimensions(self) -> tuple[Dimension, Dimension]:
        """Both."""
        return self.offset, self.scale


class DistanceTable(StatedTable):
    """Distances from an unknown fixed point to the tip, one a row: distance = offset + scale · reading."""

    kind: Literal["distance"]
    offset: float = 0.0
    """What is added to every reading: the dead length of a wire, the bar's own."""
    u_offset: Uncertainty = 0.0
    """Standard uncertainty of the offset."""
    fit_offset: bool = False
    """Whether the offset is fitted: within its uncertainty, or freely where none is stated."""
    scale: Positive = 1.0
    """What every reading is multiplied by."""
    u_scale: Uncertainty = 0.0
    """Standard uncertainty of the scale."""
    fit_scale: bool = False
    """Whether the scale is fitted: within its uncertainty, or freely where none is stated."""

    def made(self, name: str, place: Place) -> Artefact:
        """Without features: nobody touches it. Raises UlnaInputError where nothing would be known."""
        mm = place.units.mm
        own = Instrument(
            Dimension("offset", self.offset * mm, self.u_offset * mm, self.fit_offset),
            Dimension("scale", self.scale, self.u_scale, self.fit_scale, "1"),
        )
        return Artefact(name, "distance", {}, own=own)


class SimulatedDistance(DistanceTable, TouchedTable):
    """An instrument, and how far away the tip is when it measures."""

    range: Annotated[list[Positive], Field(min_length=2, max_length=2)] | None = None
    """Least and largest distance from the fixed point (200 mm, 600 mm)."""

    def size_mm(self, mm: float) -> tuple[float, float] | None:
        """The range."""
        return None if self.range is None else (self.range[0] * mm, self.range[1] * mm)


def instrument(artefact: Artefact) -> Instrument:
    """What is stated of an artefact of this kind."""
    assert isinstance(artefact.own, Instrument)
    return artefact.own


class Distance(Kind):
    """One distance a row from an unknown fixed point."""

    name = "distance"
    table, simulated = DistanceTable, SimulatedDistance
    named, scattered = False, True
    measured_column = "distance"
    residual_columns = ("distance_mm",)
    placements, touches = 3, 40
    size_mm = (200.0, 600.0)

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """Offset and scale."""
        return list(instrument(artefact).dimensions)

    def certain(self, artefact: Artefact) -> Artefact:
        """With the offset and the scale that are stated."""
        exact = (replace(each, u=0.0, fitted=False) for each in instrument(artefact).dimensions)
        return replace(artefact, own=Instrument(*exact))

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With what was measured in each row."""
        stated = [(each.name, each.value, each.u, each.fitted) for each in self.dimensions(group.artefact)]
        enter_rows(
            problem,
            "distance",
            group,
            conditions[0],
            placement=group.placement_code,
            measured_mm=group.length_mm,
            dimensions=stated,
        )

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Distances from the point that fits a placement's tips best, minus those measured; an offset or scale that is
        fitted is the one that fits best here."""
        assert readings.length_mm is not None
        own, read_mm = instrument(readings.artefact), readings.length_mm
        stands: list[_Stand] = []
        codes: list[I64] = []
        for number in range(int(tips.code.max()) + 1):
            rows = np.flatnonzero(tips.code == number)
            stand = _Stand(tips.first_mm[rows], read_mm[rows])
            if len(rows) >= FEWEST and stand.tells(own):
                stands.append(stand)
                codes.append(tips.code[rows])
        if not stands:
            return {}
        try:
            offset_mm, scale = _as_they_fit(own, stands)
            errors = [stand.errors_mm(offset_mm, scale)[0] for stand in stands]
        except UlnaInputError:  # readings that are no distances from anywhere: there is no offset or scale to find
            return {}
        return {"distance_error": Errors(np.concatenate(errors), np.concatenate(codes))}

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """The instrument's own offset and scale."""
        own = instrument(stated)
        drawn = (replace(each, value=each.value + each.u * float(rng.standard_normal())) for each in own.dimensions)
        return replace(stated, own=Instrument(*drawn))

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """The tip all around the fixed point, which is the origin, near and far."""
        number = np.arange(how.touches)
        height, angle = 2.0 * (number + 0.5) / how.touches - 1.0, 2.0 * np.pi * number * GOLDEN
        across = np.sqrt(1.0 - height**2)
        direction = np.column_stack([across * np.cos(angle), across * np.sin(angle), height])
        near_mm, far_mm = how.size_mm
        reach_mm = near_mm + (far_mm - near_mm) * ((number / PLASTIC) % 1.0)
        probe = np.repeat(how.probes, how.touches)
        away = np.tile(direction, (len(how.probes), 1))
        return Touches(np.tile(reach_mm, len(how.probes))[:, None] * away, away, probe, np.zeros(len(probe), np.int64))

    def measured_mm(
        self, stated: Artefact, true: Artefact, touches: Touches, places: int, rng: np.random.Generator
    ) -> F64 | None:
        """What the instrument reads."""
        own = instrument(true)
        read_mm: F64 = (np.linalg.norm(touches.centre_mm, axis=1) - own.offset.value) / own.scale.value
        return np.tile(read_mm, places)

    def check_simulated(self, table: TouchedTable, key: str) -> None:
        """The range goes from near to far. Raises UlnaInputError."""
        assert isinstance(table, SimulatedDistance)
        if table.range is not None and not table.range[0] < table.range[1]:
            raise UlnaInputError(f"{key}.range': got {table.range}; expected the least distance first. Swap them.")

    def check_planned(self, artefact: Artefact, touches: int, label: str) -> None:
        """Fewer rows only say where the point is; offset and scale are as stated. Raises UlnaInputError."""
        fitted = next((each.name for each in self.dimensions(artefact) if each.fitted), None)
        if fitted is not None:
            raise UlnaInputError(
                f"{label}: artefact '{artefact.name}' has fit_{fitted} = true; expected it as its certificate has it, "
                f"which a plan takes as known. Remove fit_{fitted}."
            )
        if touches < FEWEST:
            raise UlnaInputError(
                f"{label}: {touches} distances tell nothing, for the point that they are measured from is unknown; "
                f"expected {FEWEST} or more. Raise touches."
            )

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """What differs from an instrument that is right."""
        keys: dict[str, Any] = {}
        for own, right in zip(instrument(artefact).dimensions, RIGHT, strict=True):
            keys |= {own.name: own.value} if own.value != right.value else {}
            keys |= {f"u_{own.name}": own.u} if own.u else {}
            keys |= {f"fit_{own.name}": True} if own.fitted else {}
        return keys


@dataclass(frozen=True)
class _Stand:
    """Readings from one fixed point."""

    tips_mm: F64
    read_mm: F64

    def tells(self, own: Instrument) -> bool:
        """Whether there is a point: not of tips on a line, say."""
        try:
            self.errors_mm(*(each.value for each in own.dimensions))
        except UlnaInputError:
            return False
        return True

    def errors_mm(self, offset_mm: float, scale: float) -> tuple[F64, F64]:
        """(N,) errors against the point that fits best, and (N, 3) the directions in which the distances grow."""
        found = fit_point(self.tips_mm, offset_mm + scale * self.read_mm, "distance")
        away_mm = self.tips_mm - found.point_mm
        return found.residuals_mm, away_mm / np.linalg.norm(away_mm, axis=1, keepdims=True)


def _as_they_fit(own: Instrument, stands: list[_Stand]) -> tuple[float, float]:
    """Offset (mm) and scale: as stated, or, where they are fitted, those of the least squares over all placements, by
    Gauss–Newton with the fixed points eliminated."""
    fitted = np.array([each.fitted for each in own.dimensions])
    found = np.array([each.value for each in own.dimensions])
    for _ in range(MOST_STEPS if fitted.any() else 0):
        rows, left = [], []
        for stand in stands:
            errors_mm, away = stand.errors_mm(*found)
            span = np.linalg.qr(away).Q
            both = np.column_stack([np.ones(len(errors_mm)), stand.read_mm, errors_mm])
            both -= span @ (span.T @ both)
            rows.append(both[:, :2][:, fitted])
            left.append(both[:, 2])
        step = np.linalg.lstsq(np.concatenate(rows), np.concatenate(left))[0]
        found[fitted] += step
        if np.all(np.abs(step) <= STILL * np.maximum(1.0, np.abs(found[fitted]))):
            break
    return float(found[0]), float(found[1])
