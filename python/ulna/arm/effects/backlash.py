"""`backlash`: play between a joint and its encoder.

q_i + backlash_i/2 · s_i   in place of each encoder angle q_i, with s_i the side from which the joint was approached:
                           +1 where the encoder's angle had been rising, -1 where it had been falling, 0 unknown
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ulna.arm.conditions import APPROACH
from ulna.arm.effects.effect import Effect, Row
from ulna.formats.models import Strict
from ulna.formats.units import Units


class BacklashKeys(Strict):
    """Of a joint's table."""

    backlash: float | None = None
    """Play between the joint and its encoder, from one side to the other, in the file's angle unit."""


class Backlash(Effect):
    """Backlash of joints."""

    name = "backlash"
    table = BacklashKeys
    suffixes, examples = ("backlash",), ("backlash",)
    unit, drawn = "rad", 0.01
    # as of harmonics: ten times what a good joint shows; of a joint that came from one side alone readings say nothing
    prior_u = 5e-4
    needs = APPROACH
    does = "have backlash"
    words = "the backlash of its joints"
    causes = MappingProxyType(
        {
            "approach-one-sided": "an approach from one side alone",
            "approach-unknown": "an approach that nobody stated",
        }
    )
    left_out = "play between joints and their encoders"

    def has(self, own: BacklashOfJoint) -> bool:
        """Any number, zero too."""
        return own.backlash_rad is not None

    def zero(self, own: BacklashOfJoint, orders: Sequence[int]) -> dict[str, Any]:
        """No play."""
        return {"backlash_rad": own.backlash_rad or 0.0}

    def none(self) -> dict[str, Any]:
        """Nothing said."""
        return {"backlash_rad": None}

    def read(self, table: BacklashKeys, key: str, units: Units, path: Path) -> dict[str, Any]:
        """An angle."""
        return {"backlash_rad": None if table.backlash is None else table.backlash * units.rad}

    def written(self, own: BacklashOfJoint) -> dict[str, Any]:
        """One number."""
        return {} if own.backlash_rad is None else {"backlash": own.backlash_rad}

    def for_core(
        self, joints: Sequence[BacklashOfJoint], gravity: Sequence[float], payload_kg: float = 0.0
    ) -> dict[str, Any]:
        """One number a joint."""
        return {"backlash_rad": np.array([own.backlash_rad or 0.0 for own in joints])}

    def taken(self, own: BacklashOfJoint, values: Mapping[str, float]) -> dict[str, Any]:
        """One number."""
        return {"backlash_rad": values["backlash"]}


@dataclass(frozen=True)
class BacklashOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = Backlash()
    backlash_rad: float | None = None
    """Play between the joint and its encoder, from one side to the other."""
