"""A plan as everybody above uses it: what it is, and the door to its folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ulna.ground.shown import About, Shown, Table
from ulna.planning.data import PlanData
from ulna.planning.folder import files_of, save


@dataclass(frozen=True, repr=False)
class Plan(Shown, PlanData):
    """Measurements to take, in their order."""

    @property
    def files(self) -> list[str]:
        """Names of the files that `save` writes."""
        return files_of(self.spec.artefact)

    def about(self) -> About:
        """What it gains over random measurements; the list to follow is in plan.csv."""
        each = {"planned": self.planned, "random": self.random}
        rows = [[name, f"{1000.0 * figures.u_length_mm:.3g}"] for name, figures in each.items()]
        artefact = self.spec.artefact
        return About(
            f"Plan of {len(self.chosen)} measurements of {artefact.kind} '{artefact.name}' with '{self.arm.name}'",
            {"chosen from": f"{self.candidates} candidates", "determined": f"{self.determined} of {self.free} free"},
            [Table(["expected length uncertainty", "µm"], rows)],
        )

    def save(self, folder: str | Path, force: bool = False, more: Mapping[str, bytes] | None = None) -> None:
        """Write the list, the machine form, an arm and a study for the readings, pictures, and `more` by name. Raises
        UlnaInputError."""
        save(self, Path(folder), force, more)
