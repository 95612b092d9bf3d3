"""One joint of an arm and the link after it. Units are mm and rad, always."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ulna.arm.effects.effects import NONE, Effects

JointModel = Literal["dh", "hayati"]


@dataclass(frozen=True)
class Joint:
    """One rotary joint and the link after it. The last joint has no link, unless the arm has a full last link."""

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
    """Lowest and highest encoder angle; readings outside are warned about."""
    counts_per_turn: float | None = None
    """Encoder counts in one full turn; needed for readings in counts."""
    effects: Effects = NONE
    """What the joint does beyond its geometry."""


#: no arm's joint turns farther than this from its zero: two turns
MOST_RAD = 4.0 * math.pi
