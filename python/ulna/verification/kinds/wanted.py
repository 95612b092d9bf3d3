"""Artefacts that tests want touched: how a plan asks for them, and how a virtual arm touches them. Lengths mm."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from ulna.artefacts.surface import GOLDEN
from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.verification.bench import Bench
from ulna.verification.certified import BallTable, CalibratedLengthTable, CertifiedTable
from ulna.verification.kinds.steps import Step

BALL_MM = 25.0
#: half the width of a gauge's faces
FACE_MM = 4.0
FACE_TOUCHES = 3
"""Of a face of a gauge: they make a plane."""
ANYWHERE = (0.1, 0.9)
"""Shares of the reach between which a seat stands of which nothing else is said."""


class Key(NamedTuple):
    """A key of an artefact's table in a plan."""

    name: str
    value: str | None
    """None where its certificate says it."""
    example: str = ""
    """What it may look like, and what it is."""


@dataclass(frozen=True)
class Wanted(ABC):
    """Something to be touched."""

    RANK: ClassVar[int]
    """Plans list artefacts by it, then in the order of the tests."""
    SIZE: ClassVar[str | None]
    """The key of its length or diameter in its table; None where it has none."""
    KIND: ClassVar[str]
    """Of its table in a verify file."""

    name: str

    def ranks_with(self, other: Wanted) -> bool:
        """Whether the same artefacts of a file can be this one and another one; those of a list rise in size."""
        return type(self) is type(other)

    @abstractmethod
    def fits(self, table: CertifiedTable) -> bool:
        """Whether an artefact of a verify file, or of a protocol, can be what is wanted."""

    @abstractmethod
    def size_of(self, table: CertifiedTable) -> float:
        """The length or diameter that it states, in its file's unit; 0 where it has none."""

    @abstractmethod
    def true_mm(self, bench: Bench, name: str, test: str) -> float:
        """The same of an artefact by its name, at the temperature of the test. Raises UlnaInputError."""

    @abstractmethod
    def apart(self, one: Step, other: Step, true_mm: float, tip_mm: float) -> tuple[float, float]:
        """Between which distances the ball's centres are at two steps in one of its places; sizes as in `touched`."""

    @abstractmethod
    def keys(self, range_mm: float | None = None) -> list[Key]:
        """Of its table in a verify file, with examples for a measuring range; [] where there is no such table."""

    @abstractmethod
    def stated(self, range_mm: float) -> dict[str, Any]:
        """Its table as an example's certificate has it, for an arm of this measuring range; {} where there is none."""

    @abstractmethod
    def touched(self, steps: Sequence[Step], true_mm: float, tip_mm: float) -> F64:
        """(N, 3) centres of the probe's ball in its own frame at the steps in one of its places, `true_mm` its true
        size (0 where it has none), `tip_mm` the diameter of the probe's ball."""

    def between(self, position: str) -> tuple[float, float] | None:
        """Shares of the reach between which it stands in a place; None where it may stand anywhere."""
        return None


@dataclass(frozen=True)
class WantedBall(Wanted):
    """A calibrated ball, each measurement of it spread over the half that is away from its stem."""

    RANK: ClassVar[int] = 0
    SIZE: ClassVar[str | None] = "diameter"
    KIND: ClassVar[str] = "ball"

    name: str = "ball"

    def fits(self, table: CertifiedTable) -> bool:
        return isinstance(table, BallTable)

    def size_of(self, table: CertifiedTable) -> float:
        assert isinstance(table, BallTable)
        return table.diameter

    def true_mm(self, bench: Bench, name: str, test: str) -> float:
        return bench.ball(name, test).diameter_mm

    def apart(self, one: Step, other: Step, true_mm: float, tip_mm: float) -> tuple[float, float]:
        return 0.0, true_mm + tip_mm

    def keys(self, range_mm: float | None = None) -> list[Key]:
        return [
            Key("kind", "ball"),
            Key("diameter", None, "25.0000        # from its certificate"),
            Key("u", None, "0.0003                # standard uncertainty: U / k"),
            Key("form", None, "0.0005             # peak to valley"),
            Key("expansion", None, "5.5e-6        # 1/K"),
            Key("u_expansion", None, "0.5e-6"),
        ]

    def stated(self, range_mm: float) -> dict[str, Any]:
        return {"diameter": BALL_MM, "u": 0.0003, "form": 0.0005, "expansion": 5.5e-6, "u_expansion": 0.5e-6}

    def touched(self, steps: Sequence[Step], true_mm: float, tip_mm: float) -> F64:
        parts = []
        for _, run in groupby(steps, lambda step: (step.orientation, step.repeat)):
            count = len(list(run))
            number = np.arange(count)
            height = (number + 0.5) / count
            angle, radius = 2.0 * np.pi * number * GOLDEN, np.sqrt(1.0 - height**2)
            parts.append(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height]))
        return 0.5 * (true_mm + tip_mm) * np.concatenate(parts)


@dataclass(frozen=True)
class WantedLength(Wanted):
    """A calibrated length between ends A and B: two seats, or the faces of a gauge touched from outside."""

    RANK: ClassVar[int] = 1
    SIZE: ClassVar[str | None] = "length"
    KIND: ClassVar[str] = "length"

    share: float
    """Of the measuring range."""
    ends: Literal["seats", "opposite-faces"]

    @property
    def faces(self) -> bool:
        """Whether it ends in faces."""
        return self.ends == "opposite-faces"

    def ranks_with(self, other: Wanted) -> bool:
        return isinstance(other, WantedLength) and self.faces == other.faces

    def fits(self, table: CertifiedTable) -> bool:
        return isinstance(table, CalibratedLengthTable) and (table.ends == "opposite-faces") == self.faces

    def size_of(self, table: CertifiedTable) -> float:
        assert isinstance(table, CalibratedLengthTable)
        return table.length

    def true_mm(self, bench: Bench, name: str, test: str) -> float:
        return bench.length(name, test).calibrated_mm

    def apart(self, one: Step, other: Step, true_mm: float, tip_mm: float) -> tuple[float, float]:
        gap_mm = 0.0 if one.feature == other.feature else true_mm + (tip_mm if self.faces else 0.0)
        return gap_mm, gap_mm

    def keys(self, range_mm: float | None = None) -> list[Key]:
        length = 1000.0 if range_mm is None else self.stated(range_mm)["length"]
        return [
            Key("kind", "length"),
            Key("length", None, f"{length:<17}# from its certificate; about {100 * self.share:.0f} % of the range"),
            Key("u", None, "0.0010                # standard uncertainty: U / k"),
            Key("ends", self.ends),
            Key("expansion", None, "11.5e-6       # 1/K"),
            Key("u_expansion", None, "0.5e-6"),
        ]

    def stated(self, range_mm: float) -> dict[str, Any]:
        nominal = float(np.ceil(self.share * range_mm))
        return {"length": nominal, "u": 0.001, "expansion": 11.5e-6, "u_expansion": 0.5e-6}

    def steps(self, test: str, position: str, repeat: str = "") -> list[Step]:
        """Both ends in one place, A first."""
        said = {"artefact": self.name, "position": position}
        return [
            Step(
                test,
                self.name,
                position,
                "",
                repeat,
                feature,
                worded("{artefact} in place {position}: touch face {feature}", feature=feature, **said)
                if self.faces
                else worded("{artefact} in place {position}: touch seat {feature}", feature=feature, **said),
            )
            for feature in "AB"
            for _ in range(FACE_TOUCHES if self.faces else 1)
        ]

    def touched(self, steps: Sequence[Step], true_mm: float, tip_mm: float) -> F64:
        at_mm = np.zeros((len(steps), 3))
        gap_mm = true_mm + (tip_mm if self.faces else 0.0)
        at_mm[:, 0] = [gap_mm if step.feature == "B" else 0.0 for step in steps]
        if self.faces:
            turn = 2.0 * np.pi * np.arange(len(steps)) / 3.0
            at_mm[:, 1], at_mm[:, 2] = FACE_MM * np.cos(turn), FACE_MM * np.sin(turn)
        return at_mm


@dataclass(frozen=True)
class WantedSeat(Wanted):
    """A cone or socket of unknown place: no certificate is about it."""

    RANK: ClassVar[int] = 2
    SIZE: ClassVar[str | None] = None
    KIND: ClassVar[str] = "seat"

    name: str = ""
    places: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Position → least and most share of the reach."""

    def fits(self, table: CertifiedTable) -> bool:
        return False

    def size_of(self, table: CertifiedTable) -> float:
        return 0.0

    def true_mm(self, bench: Bench, name: str, test: str) -> float:
        return 0.0

    def apart(self, one: Step, other: Step, true_mm: float, tip_mm: float) -> tuple[float, float]:
        return 0.0, 0.0

    def keys(self, range_mm: float | None = None) -> list[Key]:
        return []

    def stated(self, range_mm: float) -> dict[str, Any]:
        return {}

    def touched(self, steps: Sequence[Step], true_mm: float, tip_mm: float) -> F64:
        return np.zeros((len(steps), 3))

    def between(self, position: str) -> tuple[float, float] | None:
        return self.places.get(position, ANYWHERE)
