"""A study in memory: an arm, what it touched, and what to fit. Units are mm and rad, always.

Made from files by `ulna.study.file`; nothing here reads or writes.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ulna.arm.model import Arm

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Bool = NDArray[np.bool_]

ArtefactKind = Literal["bar", "seat", "points", "length", "sphere", "plane"]
Loss = Literal["none", "huber", "cauchy", "tukey"]
Method = Literal["lm", "annealing", "evolution"]

SURFACES = ("sphere", "plane")
"""Kinds that are touched with the ball of the tip on their surface."""


@dataclass(frozen=True)
class Artefact:
    """A set of features with calibrated coordinates: what the arm touches."""

    name: str
    kind: ArtefactKind
    features: dict[str, tuple[float, float, float]]
    """Coordinates in mm, in the artefact's own frame. bar: A at 0 and B at its length; seat: ``seat``; others: none."""
    length_mm: float | None = None
    """bar only: distance between its seats."""
    u_mm: float = 0.0
    """Standard uncertainty: of the length of a bar or of length rows, of the diameter of a sphere; per coordinate of
    each feature of points, where `feature_u_mm` does not say it of each."""
    frame: Literal["free", "arm"] = "free"
    """"arm": the coordinates are in the arm's base frame; "free": each placement stands at an unknown pose."""
    feature_u_mm: tuple[float, ...] | None = None
    """points only: standard uncertainty of the coordinates of each feature, in the order of `features`."""
    diameter_mm: float | None = None
    """sphere only."""
    inside: bool = False
    """sphere only: a hollow, touched from within."""
    fitted: bool = False
    """What is uncertain of it (the diameter, the length, the features) is fitted, within its uncertainty; a sphere's
    diameter of which no uncertainty is stated is fitted freely. Else it stays, and its uncertainty counts."""


@dataclass(frozen=True)
class InputFile:
    """A file that was read, so that a result can say from what it was made."""

    path: Path
    sha256: str
    rows: int
    """Data rows; 0 for a file that has none (an arm, a study)."""


@dataclass
class Readings:
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
    placement: NDArray[np.object_]
    """(N,) str labels; equal means the same standing of the artefact."""
    row: I64
    """(N,) data row in its file, counted from 1, the header not counted."""
    file: I64
    """(N,) index into `Study.files`."""
    id: NDArray[np.object_] | None = None
    """(N,) str, where the file has a column ``id``."""
    temperature_c: F64 | None = None
    """(N,) or (N, n), °C."""

    def __len__(self) -> int:
        return len(self.q_rad)

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
        )

    @property
    def placement_code(self) -> I64:
        """(N,) a number for each placement label, counted in the order in which they appear."""
        seen: dict[str, int] = {}
        return np.fromiter((seen.setdefault(label, len(seen)) for label in self.placement), np.int64, len(self))


@dataclass(frozen=True)
class Noise:
    """Standard deviations of the readings. Without it every reading weighs one."""

    encoder_rad: F64 | None = None
    """(n,) per joint."""
    seat_mm: float | None = None
    """Of a touch, per coordinate."""


@dataclass(frozen=True)
class Prior:
    """What is known of parameters before any reading."""

    u: float
    """Standard deviation."""
    value: float | None = None
    """None: the value in the arm file, or of the artefact."""
    length_mm: float = 1.0
    """mm in the unit of length that u and value are in, for parameters that are lengths."""
    angle_rad: float = 1.0
    """The same for angles."""

    def in_unit(self, unit: str) -> tuple[float, float | None]:
        """u and value for a parameter of this unit: "rad", "mm", "1/K" or "rad/(N m)"."""
        factor = self.length_mm if unit == "mm" else self.angle_rad if unit.startswith("rad") else 1.0
        return self.u * factor, None if self.value is None else self.value * factor


@dataclass(frozen=True)
class FitOptions:
    """What is fitted, and how."""

    hold: list[str] = field(default_factory=list)
    """Shell-style patterns over parameter names that are not fitted."""
    free: list[str] = field(default_factory=lambda: ["*"])
    """Patterns of what may be fitted; `hold` wins."""
    loss: Loss = "none"
    """How residuals count that are far off: by their squares, or less."""
    start: Literal["given", "search"] = "given"
    """"search": the zero offsets are not known, find them."""
    extras: list[str] = field(default_factory=list)
    """Blocks of the model beyond geometry: "encoder-harmonics", "link-expansion", "compliance"."""
    harmonics: list[int] = field(default_factory=lambda: [1, 2])
    """Orders of the encoders' harmonics, where extras ask for them."""
    prior: dict[str, Prior] = field(default_factory=dict)
    """Shell-style patterns over parameter names; where several match, the last one holds."""
    judge_extras: bool = True
    """Whether extras are judged by cross-validation, refitting without each."""
    method: Method = "lm"
    """"annealing", "evolution": the box around the start is searched without derivatives, and what it finds is finished
    by "lm"."""
    budget: int = 100_000
    """How often such a search may evaluate the sum of squares."""
    box_length_mm: float = 100.0
    """Half the width of the box searched, for lengths."""
    box_angle_rad: float = 0.2
    """The same for twists."""
    box_offset_rad: float = 1.0
    """The same for zero offsets; with start "search" the whole turn."""
    seed: int = 0
    """Of the search over starts, and of the methods without derivatives."""
    max_iterations: int = 200
    known_length_mm: float = 1.0
    """How well lengths are known before any reading: a parameter determined worse than this is called weak."""
    known_angle_rad: float = 0.01
    """The same for angles."""


@dataclass
class Study:
    """What to fit to what."""

    path: Path | None
    arm: Arm
    readings: list[Readings]
    """One per artefact that was touched."""
    noise: Noise | None = None
    fit: FitOptions = field(default_factory=FitOptions)
    files: list[InputFile] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    """Remarks made while reading; also issued as InputWarning."""
    rows: Literal["fit", "check", "all"] | None = None
    """Which rows these are, where the study keeps some to check the fit; None where it does not."""

    @classmethod
    def load(cls, path: str | Path, rows: Literal["fit", "check", "all"] = "fit") -> Study:
        """Read a study file (`ulna-study/1`) and all that it names. Raises UlnaInputError; warns with InputWarning.

        rows: where the study has a split, the rows to fit, the rows kept to check the fit, or both.
        """
        from ulna.study.file import load_study  # the door to the files stands here for the user

        return load_study(Path(path), rows)

    @property
    def label(self) -> str:
        """How messages call this study."""
        return "study" if self.path is None else str(self.path)

    def subset(self, masks: list[Bool]) -> Study:
        """The same study with only some rows: one mask (N,) for each of `readings`; artefacts left empty drop out."""
        kept = [group.select(mask) for group, mask in zip(self.readings, masks, strict=True)]
        return replace(self, readings=[group for group in kept if len(group)])

    def with_arm(self, arm: Arm) -> Study:
        """The same readings, to be explained by another arm."""
        return replace(self, arm=arm)
