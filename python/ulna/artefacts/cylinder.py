"""`cylinder`: a shaft, or a bore, touched on its surface; its axis is unknown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.entering import enter_surface
from ulna.artefacts.kind import Dimension, Errors, Tips, Touches, Touching, off_by
from ulna.artefacts.readings import Readings
from ulna.artefacts.surface import GOLDEN, Surface, check_fitting, check_known, of_placements
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.formats.numbers import Positive, Uncertainty
from ulna.geometry.cylinder import fit_cylinder
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

FEWEST = 6
"""Touches that leave something to judge: one more than a cylinder can meet."""


class CylinderTable(StatedTable):
    """A shaft, or a bore, touched on its surface; its axis is unknown."""

    kind: Literal["cylinder"]
    diameter: Positive
    u: Uncertainty = 0.0
    """Standard uncertainty of the diameter."""
    fit: bool = False
    """Whether the diameter is fitted: within its uncertainty, or freely where none is stated."""
    inside: bool = False
    """Whether it is a bore, touched from within."""

    def made(self, name: str, place: Place) -> Artefact:
        """With its diameter."""
        mm = place.units.mm
        return Artefact(
            name, "cylinder", {}, None, self.u * mm, diameter_mm=self.diameter * mm, inside=self.inside, fitted=self.fit
        )


class SimulatedCylinder(CylinderTable, TouchedTable):
    """A cylinder, and how it is touched: all around."""

    height: Positive | None = None
    """How much of it is touched along its axis (100 mm)."""

    def size_mm(self, mm: float) -> tuple[float, float] | None:
        """Its height, twice: a cylinder goes all around."""
        return None if self.height is None else (self.height * mm, self.height * mm)


class Cylinder(Surface):
    """A shaft or a bore."""

    name = "cylinder"
    table, simulated = CylinderTable, SimulatedCylinder
    least_planned = 5
    size_mm = (100.0, 100.0)

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """Its diameter."""
        return [Dimension("diameter", artefact.diameter_mm or 0.0, artefact.u_mm, artefact.fitted)]

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With its diameter and the probes' balls."""
        artefact = group.artefact
        assert artefact.diameter_mm is not None
        diameter = ("diameter", artefact.diameter_mm, artefact.u_mm, artefact.fitted)
        enter_surface(
            problem, "cylinder", group, balls_mm, conditions[0], dimensions=[diameter], inside=artefact.inside
        )

    def check_probes(self, artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
        """The balls are known, and go into a bore. Raises UlnaInputError."""
        check_known(artefact, arm, used, label)
        check_fitting(artefact, arm, used, label)

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Form, and the diameter of the least-squares cylinder of each placement minus the calibrated one."""
        artefact = readings.artefact
        assert artefact.diameter_mm is not None
        sign, stated_mm = -1.0 if artefact.inside else 1.0, artefact.diameter_mm

        def judge(centre_mm: F64, ball_mm: F64) -> tuple[float, float] | None:
            try:
                cylinder = fit_cylinder(centre_mm, artefact.name, offsets_mm=0.5 * sign * ball_mm)
            except UlnaInputError:  # touches on a line, say: no cylinder is nearest to them
                return None
            return float(cylinder.form_mm), 2.0 * float(cylinder.radius_mm) - stated_mm

        return of_placements(tips, FEWEST, judge, ("form", "diameter_error"))

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Thicker or thinner."""
        return off_by(stated, "diameter_mm", rng)

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """All around, evenly along the axis, which is z."""
        assert true.diameter_mm is not None
        number = np.arange(how.touches)
        height_mm = how.size_mm[1] * ((number + 0.5) / how.touches - 0.5)
        angle = 2.0 * np.pi * number * GOLDEN
        outward = np.tile(np.column_stack([np.cos(angle), np.sin(angle), np.zeros(how.touches)]), (len(how.probes), 1))
        probe = np.repeat(how.probes, how.touches)
        side = -1.0 if true.inside else 1.0
        centre_mm = 0.5 * (true.diameter_mm + side * how.balls_mm[probe])[:, None] * outward
        centre_mm[:, 2] = np.tile(height_mm, len(how.probes))
        return Touches(centre_mm, side * outward, probe, np.zeros(len(probe), np.int64))

    def moved_by(self, touches: Touches) -> F64:
        """The axis across itself, and two tilts about its middle."""
        across, along = touches.off[:, :2], touches.centre_mm[:, 2:]
        return np.column_stack([across, across * along / np.abs(along).max()])

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """Its diameter, and the side that is touched."""
        return {"diameter": artefact.diameter_mm, "inside": artefact.inside}
