"""What tables of artefacts have in common: those of a study or a plan, and those of a simulation."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from pydantic import Discriminator, Field, Tag

from ulna.arm.stated import each_kind
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import InputFile
from ulna.formats.models import Strict
from ulna.formats.units import Units


@dataclass(frozen=True)
class Place:
    """Where a table stands: its file, the file's units, and what reading it brings along."""

    path: Path
    units: Units
    remarks: list[str]
    files: list[InputFile] = field(default_factory=list)
    """Files that artefacts were made from are added."""


class StatedTable(Strict):
    """The table of one artefact, of any kind."""

    kind: str

    @abstractmethod
    def made(self, name: str, place: Place) -> Artefact:
        """The artefact, in mm. Raises UlnaInputError."""


Times = Annotated[int, Field(ge=1, le=10_000_000)]
Probes = Annotated[
    Annotated[str, Tag("<all>")] | Annotated[Annotated[list[str], Field(min_length=1)], Tag("<each>")],
    Discriminator(each_kind),
]


class TouchedTable(StatedTable):
    """How an artefact is touched, beside what it is."""

    placements: Times | None = None
    """How often it stands somewhere (seat: 1; bar: 100; length: 100 rows; others: 5)."""
    touches: Times | None = None
    """Of each feature with each probe at each placement (seat: 30; others: 1); of a sphere or plane: in all (20)."""
    probe: Probes | None = None
    """One, or a list; the arm's only one where it is not given."""

    def size_mm(self, mm: float) -> tuple[float, float] | None:
        """How large a part is touched, where the artefact has no end of its own and the file says it; mm: in a unit."""
        return None
