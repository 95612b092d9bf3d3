"""An artefact in memory: what the arm touches. Units are mm, always."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.shown import About, Shown, Table


@dataclass(frozen=True, repr=False)
class Artefact(Shown):
    """A set of features with calibrated coordinates: what the arm touches."""

    name: str
    kind: str
    """One of `ulna.artefacts.kinds.KINDS`."""
    features: dict[str, tuple[float, float, float]]
    """Coordinates in mm, in the artefact's own frame. bar: A at 0 and B at its length; seat: ``seat``; others: none."""
    length_mm: float | None = None
    """bar only: distance between its seats."""
    u_mm: float = 0.0
    """Standard uncertainty: of the length of a bar or of length rows, of the diameter of what is round; per coordinate
    of each feature of points, where `feature_u_mm` does not say it of each."""
    frame: Literal["free", "arm"] = "free"
    """"arm": the coordinates are in the arm's base frame; "free": each placement stands at an unknown pose."""
    feature_u_mm: tuple[float, ...] | None = None
    """points only: standard uncertainty of the coordinates of each feature, in the order of `features`."""
    diameter_mm: float | None = None
    """Of what is round."""
    inside: bool = False
    """Of what is round: a hollow, touched from within."""
    fitted: bool = False
    """What is uncertain of it (the diameter, the length, the features) is fitted, within its uncertainty; a diameter of
    which no uncertainty is stated is fitted freely. Else it stays, and its uncertainty counts."""
    record: str | None = None
    """Where a record lent it: its name there."""
    own: object = None
    """What only its kind knows of it, as a record of the kind's own file."""

    @property
    def stated(self) -> str:
        """What a certificate says of it, in few words."""
        said = []
        if self.length_mm is not None:
            said.append(f"{self.length_mm:g} mm")
        if self.diameter_mm is not None:
            said.append(f"⌀ {self.diameter_mm:g} mm")
        if len(self.features) > 2:
            said.append(f"{len(self.features)} features")
        if self.u_mm:
            said.append(f"u {self.u_mm:g} mm")
        return ", ".join(said) or "–"

    def about(self) -> About:
        """What it is, and where its features are."""
        rows = [[name, *(f"{value:.4f}" for value in place)] for name, place in self.features.items()]
        tables = [Table(["feature", "x / mm", "y / mm", "z / mm"], rows)] if rows else []
        return About(f"Artefact '{self.name}': {self.kind}, {self.stated}".removesuffix(", –"), {}, tables)


def features_mm(artefact: Artefact) -> F64:
    """(F, 3) coordinates of its features."""
    return np.array(list(artefact.features.values()), dtype=np.float64).reshape(-1, 3)
