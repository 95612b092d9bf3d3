"""`sphere`: a ball, or a hollow, touched on its surface; its place is unknown."""

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
from ulna.geometry.sphere import fit_sphere
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

FEWEST = 5
"""Touches that leave something to judge: one more than a sphere can meet."""


class SphereTable(StatedTable):
    """A ball, or a hollow, touched on its surface; its place is unknown."""

    kind: Literal["sphere"]
    diameter: Positive
    u: Uncertainty = 0.0
    """Standard uncertainty of the diameter."""
    fit: bool = False
    """Whether the diameter is fitted: within its uncertainty, or freely where none is stated."""
    inside: bool = False
    """Whether it is a hollow, touched from within."""

    def made(self, name: str, place: Place) -> Artefact:
        """With its diameter."""
        mm = place.units.mm
        return Artefact(
            name, "sphere", {}, None, self.u * mm, diameter_mm=self.diameter * mm, inside=self.inside, fitted=self.fit
        )


class SimulatedSphere(SphereTable, TouchedTable):
    """A sphere, and how it is touched: over one half of it."""


class Sphere(Surface):
    """A ball or a hollow."""

    name = "sphere"
    table, simulated = SphereTable, SimulatedSphere

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """Its diameter."""
        return [Dimension("diameter", artefact.diameter_mm or 0.0, artefact.u_mm, artefact.fitted)]

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With its diameter and the probes' balls."""
        artefact = group.artefact
        assert artefact.diameter_mm is not None
        enter_surface(
            problem,
            "sphere",
            group,
            balls_mm,
            conditions[0],
            dimensions=[("diameter", artefact.diameter_mm, artefact.u_mm, artefact.fitted)],
            inside=artefact.inside,
        )

    def check_probes(self, artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
        """The balls are known, and go into a hollow. Raises UlnaInputError."""
        check_known(artefact, arm, used, label)
        check_fitting(artefact, arm, used, label)

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Form, and the diameter of the least-squares sphere of each placement minus the calibrated one."""
        artefact = readings.artefact
        assert artefact.diameter_mm is not None
        sign, stated_mm = -1.0 if artefact.inside else 1.0, artefact.diameter_mm

        def judge(centre_mm: F64, ball_mm: F64) -> tuple[float, float] | None:
            try:
                sphere = fit_sphere(centre_mm, artefact.name, offsets_mm=0.5 * sign * ball_mm)
            except UlnaInputError:  # touches on a circle, say: no sphere is nearest to them
                return None
            return float(sphere.form_mm), 2.0 * float(sphere.radius_mm) - stated_mm

        return of_placements(tips, FEWEST, judge, ("form", "diameter_error"))

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Larger or smaller."""
        return off_by(stated, "diameter_mm", rng)

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """The half of the sphere away from its stem, evenly; of a hollow the half that is opposite its mouth."""
        assert true.diameter_mm is not None
        number = np.arange(how.touches)
        height = (number + 0.5) / how.touches
        angle, radius = 2.0 * np.pi * number * GOLDEN, np.sqrt(1.0 - height**2)
        outward = np.tile(
            np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height]), (len(how.probes), 1)
        )
        probe = np.repeat(how.probes, how.touches)
        side = -1.0 if true.inside else 1.0
        centre_mm = 0.5 * (true.diameter_mm + side * how.balls_mm[probe])[:, None] * outward
        return Touches(centre_mm, side * outward, probe, np.zeros(len(probe), np.int64))

    def moved_by(self, touches: Touches) -> F64:
        """The centre."""
        return touches.off

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """Its diameter, and the side that is touched."""
        return {"diameter": artefact.diameter_mm, "inside": artefact.inside}
