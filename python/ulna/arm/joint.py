"""One joint of an arm and the link after it. Units are mm and rad, always."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ulna.arm.effects.effects import NONE, Effects

JointModel = Literal["dh", "hayati"]
JointType = Literal["rotary", "prismatic"]


@dataclass(frozen=True)
class Joint:
    """One joint and the link after it. The last joint has no link, unless the arm has a full last link.

    A prismatic one does not turn, it slides along its axis: ``Rz(-theta0) · Tz(d + sign q) · Tx(a) · Rx(alpha)``. What
    is said of the angle of its encoder, here and everywhere, is then a length in mm.
    """

    theta0_rad: float = 0.0
    """Zero offset: ``turn = sign * encoder - theta0``."""
    alpha_rad: float = 0.0
    """Twist from this axis to the next, about the link."""
    a_mm: float = 0.0
    """Link length, along the common normal of this axis and the next."""
    d_mm: float = 0.0
    """Link offset along this axis; 0 for a Hayati joint."""
    beta_rad: float = 0.0
    """Hayati joints only: tilt of the next axis about y; 0 for a DH joint."""
    sign: int = 1
    """+1 where the encoder counts up with the turn (right-handed about the axis), else -1; 0: not known, find it."""
    model: JointModel = "dh"
    """"hayati" for an axis (nearly) parallel to the next, where ``d`` has no meaning."""
    name: str | None = None
    """What people call it; only for messages."""
    limits_rad: tuple[float, float] | None = None
    """Lowest and highest encoder angle; readings outside are warned about. Of a prismatic joint mm."""
    counts_per_turn: float | None = None
    """Encoder counts in one full turn; needed for readings in counts."""
    effects: Effects = NONE
    """What the joint does beyond its geometry."""
    endless: bool = False
    """It turns on and on, and its encoder counts the turns; such a joint has no limits."""
    type: JointType = "rotary"
    """"prismatic" for one that slides along its axis; such a joint has limits, mm."""

    @property
    def slides(self) -> bool:
        """Whether its encoder reads mm."""
        return self.type == "prismatic"

    @property
    def unit(self) -> str:
        """Of its encoder's readings, inside Ulna: "rad" or "mm"."""
        return "mm" if self.slides else "rad"

    @property
    def travel_rad(self) -> tuple[float, float] | None:
        """How far it need turn to take every posture: its limits, or one turn of an endless one; None: nobody said."""
        return (-math.pi, math.pi) if self.endless else self.limits_rad

    @property
    def most_rad(self) -> float:
        """An encoder angle beyond which its unit is asked about: two turns, or as far as its limits."""
        if self.endless or self.slides:
            return math.inf
        low, high = self.limits_rad or (0.0, 0.0)
        return max(MOST_RAD, -low, high)

    @property
    def goes_round(self) -> bool:
        """Whether it is known to turn all the way round, so that its encoder may have counted turns."""
        low, high = self.limits_rad or (0.0, 0.0)
        return not self.slides and (self.endless or high - low >= 2.0 * math.pi * (1.0 - 1e-9))


#: a joint of which nothing else is said does not turn farther than this from its zero: two turns
MOST_RAD = 4.0 * math.pi
