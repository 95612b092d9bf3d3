"""A study in memory: an arm, what it touched, and what to fit. Units are mm and rad, always.

Made from files by `ulna.study.file`; nothing here reads or writes.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, NamedTuple, Self

from ulna.arm.arm import Arm
from ulna.artefacts.readings import InputFile, Readings
from ulna.ground.arrays import F64, Bool

Loss = Literal["none", "huber", "cauchy", "tukey"]
Method = Literal["lm", "annealing", "evolution"]

AUTO = "auto"
"""In place of a list of blocks: choose them."""


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
        """u and value for a parameter of this unit: "rad", "mm", "1/K", "rad/(N m)" or "1"."""
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
    """Blocks of the model beyond geometry, by their names in `ulna.arm.effects`; given as "auto" they are chosen by
    readings left out: `auto` is then true, and there are none until they are."""
    auto: bool = False
    """Whether `calibrate` chooses the blocks, their orders and priors."""
    harmonics: list[int] = field(default_factory=lambda: [1, 2])
    """Orders of the encoders' harmonics, where extras ask for them."""
    prior: dict[str, Prior] = field(default_factory=dict)
    """Shell-style patterns over parameter names; where several match, the last one holds."""
    judge_extras: bool = True
    """Whether extras are judged by cross-validation, refitting without each."""
    judge: bool = False
    """Whether it is judged if residuals still follow the turn of a joint: a map of them, by the extra `judge`."""
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
    poor_above_mm: float | None = None
    """A minimum whose residuals are larger, root mean square, is poor. None: where the stated noise does not explain
    them (chi² per degree of freedom up to 3) and they are more than a thousandth of the reach."""

    def __post_init__(self) -> None:
        given: list[str] | str = self.extras
        if given == AUTO:
            object.__setattr__(self, "extras", [])
            object.__setattr__(self, "auto", True)
        elif self.extras:  # somebody has chosen
            object.__setattr__(self, "auto", False)


class Taken(NamedTuple):
    """What a column of a table that somebody keeps is taken for."""

    column: str
    ours: str
    """Ulna's name; "" where it is not used."""
    why: str


@dataclass
class StudyData:
    """What to fit to what, without its files: see `ulna.study.study.Study`."""

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

    taken: list[Taken] = field(default_factory=list)
    """What each column was taken for, where that was guessed."""

    @property
    def label(self) -> str:
        """How messages call this study."""
        return "study" if self.path is None else str(self.path)

    def subset(self, masks: list[Bool]) -> Self:
        """The same study with only some rows: one mask (N,) for each of `readings`; artefacts left empty drop out."""
        kept = [group.select(mask) for group, mask in zip(self.readings, masks, strict=True)]
        return replace(self, readings=[group for group in kept if len(group)])

    def with_arm(self, arm: Arm) -> Self:
        """The same readings, to be explained by another arm."""
        return replace(self, arm=arm)
