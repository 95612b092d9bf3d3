"""What round kinds have in common, touched on their surface from outside or from within: a diameter."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.dimension import Dimension, off_by
from ulna.artefacts.entering import enter_surface
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.readings import Readings
from ulna.artefacts.surface import Surface, check_fitting, check_known, of_placements
from ulna.artefacts.tables import Place, StatedTable
from ulna.artefacts.touching import Touches, Touching
from ulna.formats.numbers import Positive, Uncertainty
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


class RoundTable(StatedTable):
    """What is stated of something round."""

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
        u_mm, diameter_mm = self.u * mm, self.diameter * mm
        return Artefact(name, self.kind, {}, None, u_mm, diameter_mm=diameter_mm, inside=self.inside, fitted=self.fit)


class Round(Surface):
    """Something round: how far its touches are from its centre, or from its axis, is known."""

    fewest: ClassVar[int]
    """Touches that leave something to judge: one more than can always be met."""

    @abstractmethod
    def fitted(self, centre_mm: F64, offsets_mm: F64, what: str) -> tuple[float, float]:
        """Form and radius, mm, of the least-squares figure of ball centres (N, 3) that are (N,) farther out than its
        surface. Raises UlnaInputError where there is none; what: how messages call it."""

    @abstractmethod
    def outward(self, touches: int, size_mm: tuple[float, float]) -> tuple[F64, F64]:
        """(T, 3) directions in which touches are spread over it, and (T, 3) mm where they start, in its own frame."""

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """Its diameter."""
        return [Dimension("diameter", artefact.diameter_mm or 0.0, artefact.u_mm, artefact.fitted)]

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With its diameter and the probes' balls; the core calls it by the same name."""
        artefact = group.artefact
        stated = [(each.name, each.value, each.u, each.fitted) for each in self.dimensions(artefact)]
        of = {"dimensions": stated, "inside": artefact.inside}
        enter_surface(problem, self.name, group, balls_mm, conditions[0], **of)

    def check_probes(self, artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
        """The balls are known, and go into a hollow. Raises UlnaInputError."""
        check_known(artefact, arm, used, label)
        check_fitting(artefact, arm, used, label)

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Form, and the diameter of the least-squares figure of each placement minus the calibrated one."""
        artefact = readings.artefact
        assert artefact.diameter_mm is not None
        sign, stated_mm = -1.0 if artefact.inside else 1.0, artefact.diameter_mm

        def judge(centre_mm: F64, ball_mm: F64) -> tuple[float, float] | None:
            try:
                form_mm, radius_mm = self.fitted(centre_mm, 0.5 * sign * ball_mm, artefact.name)
            except UlnaInputError:  # touches on a circle or a line, say: no figure is nearest to them
                return None
            return form_mm, 2.0 * radius_mm - stated_mm

        return of_placements(tips, self.fewest, judge, ("form", "diameter_error"))

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """Larger or smaller."""
        return off_by(stated, "diameter_mm", rng)

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """Evenly, with each probe at the same places."""
        assert true.diameter_mm is not None
        each, from_mm = self.outward(how.touches, how.size_mm)
        outward, probe = np.tile(each, (len(how.probes), 1)), np.repeat(how.probes, how.touches)
        side = -1.0 if true.inside else 1.0
        out_mm = 0.5 * (true.diameter_mm + side * how.balls_mm[probe])
        centre_mm = np.tile(from_mm, (len(how.probes), 1)) + out_mm[:, None] * outward
        return Touches(centre_mm, side * outward, probe, np.zeros(len(probe), np.int64))

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """Its diameter, and the side that is touched."""
        return {"diameter": artefact.diameter_mm, "inside": artefact.inside}
