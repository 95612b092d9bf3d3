"""Units of the files, converted once, here, to mm and rad."""

from __future__ import annotations

import math
from typing import Literal

from ulna.formats.models import Strict

LengthUnit = Literal["mm", "m", "in"]
AngleUnit = Literal["rad", "deg"]

MM_PER: dict[str, float] = {"mm": 1.0, "m": 1000.0, "in": 25.4}
RAD_PER: dict[str, float] = {"rad": 1.0, "deg": math.pi / 180.0}


class Units(Strict):
    """The units of a file. Required, never guessed."""

    length: LengthUnit
    angle: AngleUnit

    @property
    def mm(self) -> float:
        """mm in one length unit of the file."""
        return MM_PER[self.length]

    @property
    def rad(self) -> float:
        """rad in one angle unit of the file."""
        return RAD_PER[self.angle]
