"""A probe: where the centre of its ball is, and how large the ball is. Units are mm and rad, always."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64


@dataclass(frozen=True)
class Probe:
    """The centre of a probe's ball, in the frame that turns with the last joint."""

    x_mm: float
    y_mm: float
    z_mm: float
    ball_mm: float | None = None
    """Diameter of the ball."""

    @property
    def tip_mm(self) -> F64:
        """(3,) mm."""
        return np.array([self.x_mm, self.y_mm, self.z_mm])

    @property
    def cylindrical(self) -> tuple[float, float, float]:
        """``(theta0_rad, r_mm, h_mm)``: x = r cos theta0, y = -r sin theta0, z = h (Cheng 2011). r = 0: theta0 = 0."""
        return (
            math.atan2(-self.y_mm, self.x_mm) if self.x_mm or self.y_mm else 0.0,
            math.hypot(self.x_mm, self.y_mm),
            self.z_mm,
        )

    @classmethod
    def from_cylindrical(cls, theta0_rad: float, r_mm: float, h_mm: float, ball_mm: float | None = None) -> Probe:
        """From the literature's three numbers (Cheng 2011)."""
        return cls(r_mm * math.cos(theta0_rad), -r_mm * math.sin(theta0_rad), h_mm, ball_mm)
