"""What is touched in one measurement: the features of an artefact, or places spread over a surface. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.data import ArmData
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.touching import Touches
from ulna.ground.arrays import F64
from ulna.planning.spec import PlanSpec
from ulna.simulation.places import Standing
from ulna.simulation.spec import Touching
from ulna.simulation.touches import touches_of


@dataclass(frozen=True)
class Touchable:
    """K places, each touched t times in a measurement."""

    at_mm: F64
    """(K, 3) of the tip, in the artefact's own frame."""
    names: tuple[str, ...]
    """(K,) of features; numbers of a surface's places."""
    touches: int
    """t; 1 on a surface."""
    outward: F64 | None = None
    """(K, 3) away from a surface, in the artefact's own frame; None for features."""

    @property
    def pairs(self) -> bool:
        """Whether two places are touched once each, as of a bar: then all pairs of postures are candidates."""
        return len(self.at_mm) == 2 and self.touches == 1

    def standing(self, spec: PlanSpec, arm: ArmData) -> Standing:
        """Somewhere in the plan's room, where a person can put it and hold the arm."""
        name = f"{spec.label}: artefact '{spec.artefact.name}'"
        within, fixed = spec.within, spec.artefact.frame == "arm"
        if within is None:
            return Standing(self.at_mm, name, fixed, spec.room_mm)
        holds = None if fixed else within.holds
        return Standing(self.at_mm, name, fixed, spec.room_mm, holds, partial(within.bears, arm))


def spread_of(spec: PlanSpec, arm: Arm, probe: int) -> Touches:
    """The touches of one measurement of something that touches are scattered over."""
    touching = Touching(spec.artefact, 1, spec.touches, size_mm=kind_of(spec.artefact).size_mm)
    return touches_of(touching, spec.artefact, arm, [probe])


def touchable(spec: PlanSpec, arm: Arm, probe: int) -> Touchable:
    """Of the plan's artefact."""
    artefact = spec.artefact
    if not kind_of(artefact).scattered:
        at_mm = np.array(list(artefact.features.values()), dtype=np.float64).reshape(-1, 3)
        return Touchable(at_mm, tuple(artefact.features), spec.touches)
    spread = spread_of(spec, arm, probe)
    at_mm, outward = spread.centre_mm, spread.off
    names = tuple(str(number + 1) for number in range(len(at_mm)))
    return Touchable(at_mm, names, 1, outward)
