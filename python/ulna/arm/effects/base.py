"""`base-tilt` and `base-offset`: where the first axis stands in a frame that somebody stated.

p = (x, y, 0) + Rx(tilt_x) · Ry(tilt_y) · p_first

A robot's drawing, or a description, has its base frame at the middle of the flange, z up; the first axis is only nearly
there. How far the arm is turned about its first axis and how high it stands are theta0 and d of joint 1. Readings tell
these where coordinates are stated in the arm's base frame (frame = "arm").
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from ulna.arm.effects.effect import Effect, Row
from ulna.formats.models import Strict
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError

Pair = tuple[float, float]


class BaseTiltKeys(Strict):
    """Of the first joint's table."""

    base_tilt: Annotated[list[float], Field(min_length=2, max_length=2)] | None = None
    """First joint only: how far its axis leans in the base frame, about x, then about y, in the file's angle unit."""


class BaseOffsetKeys(Strict):
    """Of the first joint's table."""

    base_offset: Annotated[list[float], Field(min_length=2, max_length=2)] | None = None
    """First joint only: where its axis stands beside the base frame's origin, x and y, in the file's length unit."""


class _OfBase(Effect):
    """What both do alike: two numbers of the first joint."""

    of_first = True
    of_turn = False
    field: ClassVar[str]
    """Of what a joint has of it."""
    key: ClassVar[str]
    """Of a joint's table."""
    array: ClassVar[str]
    """As the core calls it."""
    in_unit: ClassVar[str]
    """Of `Units`: what makes a number of a file one in rad or mm."""

    def has(self, own: Any) -> bool:
        """Any numbers, zeros too."""
        return getattr(own, self.field) is not None

    def zero(self, own: Any, orders: Sequence[int]) -> dict[str, Any]:
        """Upright, at the origin."""
        return {self.field: getattr(own, self.field) or (0.0, 0.0)}

    def none(self) -> dict[str, Any]:
        """Nothing said."""
        return {self.field: None}

    def read(self, table: Any, key: str, units: Units, path: Path) -> dict[str, Any]:
        """Two numbers."""
        said, factor = getattr(table, self.key), getattr(units, self.in_unit)
        return {self.field: None if said is None else (said[0] * factor, said[1] * factor)}

    def written(self, own: Any) -> dict[str, Any]:
        """Two numbers."""
        said = getattr(own, self.field)
        return {} if said is None else {self.key: list(said)}

    def for_core(self, joints: Sequence[Any], gravity: Sequence[float], payload_kg: float = 0.0) -> dict[str, Any]:
        """Of the first joint."""
        return {self.array: np.array(getattr(joints[0], self.field) or (0.0, 0.0), dtype=np.float64)}

    def taken(self, own: Any, values: Mapping[str, float]) -> dict[str, Any]:
        """Two numbers."""
        x, y = self.suffixes
        return {self.field: (values[x], values[y])}

    def check_joints(self, joints: Sequence[Any], path: Path, payload_kg: float = 0.0) -> None:
        """Only the first axis stands on the base."""
        wrong = next((k for k, own in enumerate(joints, 1) if k > 1 and self.has(own)), None)
        if wrong is not None:
            raise UlnaInputError(
                f"{path}: key 'joint.{wrong}.{self.key}': only the first axis stands on the base; expected the key in "
                "the table of joint 1. Move it there."
            )


class BaseTilt(_OfBase):
    """A first axis that leans."""

    name = "base-tilt"
    table = BaseTiltKeys
    suffixes = examples = ("tilt_x", "tilt_y")
    unit, drawn = "rad", 0.01
    whose, does = "first axis", "leans in the base frame"
    words = "how its first axis leans in the base frame"
    left_out = "a first axis that leans in the base frame"
    field, key, array, in_unit = "base_tilt_rad", "base_tilt", "tilt_rad", "rad"


class BaseOffset(_OfBase):
    """A first axis beside the origin."""

    name = "base-offset"
    table = BaseOffsetKeys
    suffixes = examples = ("base_x", "base_y")
    unit, drawn = "mm", 1.0
    whose, does = "first axis", "stands beside the origin of the base frame"
    words = "where its first axis stands beside the origin of the base frame"
    left_out = "a first axis that stands beside the origin of the base frame"
    field, key, array, in_unit = "base_offset_mm", "base_offset", "offset_mm", "mm"


@dataclass(frozen=True)
class BaseTiltOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = BaseTilt()
    base_tilt_rad: Pair | None = None
    """First joint only: about x, then about y."""


@dataclass(frozen=True)
class BaseOffsetOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = BaseOffset()
    base_offset_mm: Pair | None = None
    """First joint only: x, y."""
