"""`cylinder`: a shaft, or a bore, touched on its surface; its axis is unknown."""

from __future__ import annotations

from typing import Literal

import numpy as np

from ulna.artefacts.round import Round, RoundTable
from ulna.artefacts.surface import GOLDEN
from ulna.artefacts.tables import TouchedTable
from ulna.formats.numbers import Positive
from ulna.geometry.cylinder import fit_cylinder
from ulna.ground.arrays import F64


class CylinderTable(RoundTable):
    """A shaft, or a bore, touched on its surface; its axis is unknown."""

    kind: Literal["cylinder"]


class SimulatedCylinder(CylinderTable, TouchedTable):
    """A cylinder, and how it is touched: all around."""

    height: Positive | None = None
    """How much of it is touched along its axis (100 mm)."""

    def size_mm(self, mm: float) -> tuple[float, float] | None:
        """Its height, twice: a cylinder goes all around."""
        return None if self.height is None else (self.height * mm, self.height * mm)


class Cylinder(Round):
    """A shaft or a bore."""

    name = "cylinder"
    lent = "diameter"
    table, simulated = CylinderTable, SimulatedCylinder
    fewest, least_planned = 6, 5
    size_mm = (100.0, 100.0)

    def fitted(self, centre_mm: F64, offsets_mm: F64, what: str) -> tuple[float, float]:
        """Of the least-squares cylinder."""
        cylinder = fit_cylinder(centre_mm, what, offsets_mm=offsets_mm)
        return float(cylinder.form_mm), float(cylinder.radius_mm)

    def outward(self, touches: int, size_mm: tuple[float, float]) -> tuple[F64, F64]:
        """All around, evenly along the axis, which is z."""
        number = np.arange(touches)
        angle, nothing = 2.0 * np.pi * number * GOLDEN, np.zeros(touches)
        along_mm = size_mm[1] * ((number + 0.5) / touches - 0.5)
        return (
            np.column_stack([np.cos(angle), np.sin(angle), nothing]),
            np.column_stack([nothing, nothing, along_mm]),
        )
