"""Readings of one artefact in memory, and the file that they came from. Units are mm and rad, always."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ulna.arm.conditions import CONDITIONS, Condition
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.labels import Labels
from ulna.formats.places import Places
from ulna.ground.arrays import F64, I64, Bool
from ulna.ground.shown import About, Shown


@dataclass(frozen=True)
class InputFile:
    """A file that was read, so that a result can say from what it was made."""

    path: Path
    sha256: str
    rows: int
    """Data rows; 0 for a file that has none (an arm, a study)."""
    places: Places | None = field(default=None, compare=False, repr=False)
    """Where they stand in the file, as its own program counts."""


@dataclass(repr=False)
class Readings(Shown):
    """All readings of one artefact, one touch a row (or, of kind length, two poses a row)."""

    artefact: Artefact
    q_rad: F64
    """(N, n) encoder angles."""
    p_rad: F64 | None
    """(N, n) encoder angles of the second pose; length rows only."""
    length_mm: F64 | None
    """(N,) distance between the two poses; length rows only."""
    probe: I64
    """(N,) index into the arm's probes."""
    feature: I64
    """(N,) index into the artefact's features, in their order; 0 for length rows."""
    placement: Labels | NDArray[np.object_]
    """(N,) str labels; equal means the same standing of the artefact. Kept as `Labels`, whatever sequence is given."""
    row: I64
    """(N,) data row in its file, counted from 1, the header not counted."""
    file: I64
    """(N,) index into `Study.files`."""
    id: NDArray[np.object_] | None = None
    """(N,) str, where the file has a column ``id``."""
    temperature_c: F64 | None = None
    """(N,) or (N, n), °C."""
    approach: F64 | None = None
    """(N, n) +1 where the encoder's angle had been rising, -1 where it had been falling, 0 where nobody knows."""
    p_approach: F64 | None = None
    """(N, n) the same of the second pose; length rows only."""
    rotation_rad: F64 | None = None
    """(N, 3) rotation vectors, from a target's frame to that of the instrument that saw it; orientations only."""
    rotation_u_rad: F64 | None = None
    """(N,) their standard uncertainty about each axis, where it is stated."""
    payload: F64 | None = None
    """(N, 4) what was carried beside the arm's own masses: mass, kg, and x, y, z of its centre in the probe's frame,
    mm."""

    @classmethod
    def none(cls, artefact: Artefact, joints: int) -> Self:
        """No reading of it yet."""
        index = np.zeros(0, dtype=np.int64)
        return cls(artefact, np.zeros((0, joints)), None, None, index, index, Labels.of([]), index, index)

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, Labels.of(value) if name == "placement" else value)

    def about(self) -> About:
        """How many, of what."""
        facts = {"probes": f"{len(np.unique(self.probe))} on", "standings": str(len(np.unique(self.placement_code)))}
        said = [name for _, name, _ in self.conditions()]
        facts |= {"said beside angles": ", ".join(said)} if said else {}
        return About(f"{len(self)} readings of {self.artefact.kind} '{self.artefact.name}'", facts)

    def __len__(self) -> int:
        return len(self.q_rad)

    @property
    def said(self) -> list[dict[str, F64 | None]]:
        """Of each pose of a row: the arguments of `Arm.conditions`."""
        approaches = [self.approach] if self.p_rad is None else [self.approach, self.p_approach]
        alike = {"temperature_c": self.temperature_c, "payload": self.payload}
        return [{**alike, "approach": approach} for approach in approaches]

    def conditions(self) -> Iterator[tuple[Condition, str, F64]]:
        """Those that are said, each with the name of its columns."""
        for condition in CONDITIONS:
            for name, key in condition.fields.items():
                said = getattr(self, key)
                if said is not None:
                    yield condition, name, said

    @property
    def labels(self) -> Labels:
        """`placement`, as it is kept."""
        return Labels.of(self.placement)

    def select(self, mask: Bool | I64) -> Readings:
        """The rows of a mask (N,) or of indices, in order."""

        def of(values: Any) -> Any:
            return None if values is None else values[mask]

        return Readings(
            artefact=self.artefact,
            q_rad=of(self.q_rad),
            p_rad=of(self.p_rad),
            length_mm=of(self.length_mm),
            probe=of(self.probe),
            feature=of(self.feature),
            placement=of(self.placement),
            row=of(self.row),
            file=of(self.file),
            id=of(self.id),
            temperature_c=of(self.temperature_c),
            approach=of(self.approach),
            p_approach=of(self.p_approach),
            rotation_rad=of(self.rotation_rad),
            rotation_u_rad=of(self.rotation_u_rad),
            payload=of(self.payload),
        )

    @property
    def placement_code(self) -> I64:
        """(N,) a number for each placement label, counted in the order in which they appear."""
        return self.labels.as_they_appear()[0]
