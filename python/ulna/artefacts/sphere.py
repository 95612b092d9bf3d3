"""`sphere`: a ball, or a hollow, touched on its surface; its place is unknown."""

from __future__ import annotations

from typing import Literal

import numpy as np

from ulna.artefacts.round import Round, RoundTable
from ulna.artefacts.surface import GOLDEN
from ulna.artefacts.tables import TouchedTable
from ulna.geometry.sphere import fit_sphere
from ulna.ground.arrays import F64


class SphereTable(RoundTable):
    """A ball, or a hollow, touched on its surface; its place is unknown."""

    kind: Literal["sphere"]


class SimulatedSphere(SphereTable, TouchedTable):
    """A sphere, and how it is touched: over one half of it."""


class Sphere(Round):
    """A ball or a hollow."""

    name = "sphere"
    lent = "diameter"
    table, simulated = SphereTable, SimulatedSphere
    fewest = 5

    def fitted(self, centre_mm: F64, offsets_mm: F64, what: str) -> tuple[float, float]:
        """Of the least-squares sphere."""
        sphere = fit_sphere(centre_mm, what, offsets_mm=offsets_mm)
        return float(sphere.form_mm), float(sphere.radius_mm)

    def outward(self, touches: int, size_mm: tuple[float, float]) -> tuple[F64, F64]:
        """The half of the sphere away from its stem, evenly; of a hollow the half that is opposite its mouth."""
        number = np.arange(touches)
        height = (number + 0.5) / touches
        angle, radius = 2.0 * np.pi * number * GOLDEN, np.sqrt(1.0 - height**2)
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height]), np.zeros((touches, 3))
