"""A plan as everybody above uses it: what it is, and the door to its folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ulna.planning.data import PlanData
from ulna.planning.folder import files_of, save


@dataclass(frozen=True)
class Plan(PlanData):
    """Measurements to take, in their order."""

    @property
    def files(self) -> list[str]:
        """Names of the files that `save` writes."""
        return files_of(self.spec.artefact)

    def save(self, folder: str | Path, force: bool = False, more: Mapping[str, bytes] | None = None) -> None:
        """Write the list, the machine form, an arm and a study for the readings, pictures, and `more` by name. Raises
        UlnaInputError."""
        save(self, Path(folder), force, more)
