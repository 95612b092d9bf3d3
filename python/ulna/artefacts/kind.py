"""What a kind of artefact owes: all that anybody asks about it. One file a kind, one row in `ulna.artefacts.kinds`.

Nobody outside this room asks which kind an artefact is of: whoever needs to know something asks the kind for it. What a
kind lacks is named by `missing`, and the contract suite goes through every row.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import InputFile, Readings
from ulna.artefacts.tables import StatedTable, TouchedTable
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Errors:
    """The single errors of one quantity, each with the placement that it belongs to."""

    value_mm: F64
    code: I64


@dataclass(frozen=True)
class Tips:
    """Where an arm says that the tip was when readings were taken."""

    first_mm: F64
    """(N, 3)"""
    second_mm: F64 | None
    """(N, 3) of the second pose; of kinds of two poses a row."""
    ball_mm: F64
    """(N,) diameter of the ball; 0 where it does not matter."""
    code: I64
    """(N,) numbers of the placements."""


@dataclass(frozen=True)
class Touching:
    """How a true artefact is touched in one placement."""

    touches: int
    """Of each feature with each probe, or in all with each probe."""
    probes: I64
    """(k,) indices of the probes that touch, each as often."""
    balls_mm: F64
    """(P,) of all the arm's probes; 0 where not known."""
    size_mm: tuple[float, float]
    """How large a part of it is touched, where the artefact itself has no end."""


@dataclass(frozen=True)
class Touches:
    """All touches of one placement, in the order in which they are read, in the artefact's own frame."""

    centre_mm: F64
    """(T, 3) of the ball."""
    off: F64
    """(T, 3) unit vector away from the surface; zero where a feature is touched, which may be missed anyhow."""
    probe: I64
    """(T,) index into the arm's probes."""
    feature: I64
    """(T,) index into the artefact's features; 0 for surfaces."""


@dataclass(frozen=True)
class Dimension:
    """One dimension of an artefact, as stated."""

    name: str
    """As in parameter names: `artefact.ball.diameter`."""
    value: float
    """In `unit`."""
    u: float
    fitted: bool
    unit: str = "mm"


class Kind(ABC):
    """One kind of artefact. What has no general answer is abstract; the rest is the answer of most kinds."""

    name: ClassVar[str]
    """As files say it."""
    table: ClassVar[type[StatedTable]]
    """Of a study file or a plan file."""
    simulated: ClassVar[type[TouchedTable]]
    """Of a simulation file: the same, and how it is touched."""
    poses: ClassVar[int] = 1
    """How many poses of the arm a row has."""
    named: ClassVar[bool]
    """Whether a row names the feature that was touched."""
    measured_column: ClassVar[str | None] = None
    """Column of a distance that was measured along with the row."""
    residual_columns: ClassVar[tuple[str, ...]]
    """Columns of a table of residuals that its readings have: the feature first, where rows name one."""
    scattered: ClassVar[bool]
    """Whether touches are spread over it; else each feature is touched as often."""
    indivisible: ClassVar[bool] = False
    """Whether a placement says nothing with some of its readings left out."""
    features_file: ClassVar[bool] = False
    """Whether its features are written into a file of their own."""
    size_mm: ClassVar[tuple[float, float]] = (200.0, 200.0)
    """How large a part of it is touched, where it has no end of its own and nobody says it."""
    placements: ClassVar[int] = 5
    """In how many places a simulation touches it."""
    touches: ClassVar[int] = 1
    """How often, there."""

    def placed(self, artefact: Artefact) -> bool:
        """Whether readings belong to standings of the artefact, whose pose nobody knows."""
        return artefact.frame == "free"

    @abstractmethod
    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """What a certificate states of it as single numbers."""

    def certain(self, artefact: Artefact) -> Artefact:
        """The artefact as if its certificate were exact: nothing of it is uncertain, nothing is fitted."""
        return replace(artefact, u_mm=0.0, feature_u_mm=None, fitted=False)

    @abstractmethod
    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """Give the readings to the core. balls_mm (P,) of the arm's probes; conditions: of each pose of a row."""

    def check_probes(self, artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
        """Whether the probes (indices) that are used can touch it, and are known where it matters; label: what messages
        call the file. Raises UlnaInputError."""
        return

    def check_readings(self, group: Readings, files: Sequence[InputFile], study: Path) -> None:
        """Whether the readings can say anything. Raises UlnaInputError."""
        return

    @abstractmethod
    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """What a metrologist reads, from the tips alone: quantity (`ulna.artefacts.quantities`) → single errors."""

    @abstractmethod
    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """The artefact itself: what its certificate states, off by normal draws of the stated uncertainties."""

    @abstractmethod
    def touched(self, true: Artefact, how: Touching) -> Touches:
        """The touches of one placement."""

    def measured_mm(
        self, stated: Artefact, true: Artefact, touches: Touches, places: int, rng: np.random.Generator
    ) -> F64 | None:
        """(N,) what is measured along with each row, in so many placements; None where nothing is."""
        return None

    def check_simulated(self, table: TouchedTable, key: str) -> None:
        """Whether it can be touched as a simulation file says; key: of its table; raises UlnaInputError."""
        return

    def check_planned(self, artefact: Artefact, touches: int, label: str) -> None:
        """Whether measurements of it can be planned. Raises UlnaInputError."""
        return

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """The keys of its table in a study file, but the kind; mm. features_file: where its features are written."""
        return {}

    def __repr__(self) -> str:
        return f"kind {self.name}"


def features_mm(artefact: Artefact) -> F64:
    """(F, 3) coordinates of its features."""
    return np.array(list(artefact.features.values()), dtype=np.float64).reshape(-1, 3)


def touched_features(points_mm: F64, how: Touching) -> Touches:
    """Every one of (F, 3) points as often, probe after probe."""
    feature = np.tile(np.repeat(np.arange(len(points_mm)), how.touches), len(how.probes))
    probe = np.repeat(how.probes, len(points_mm) * how.touches)
    return Touches(points_mm[feature], np.zeros((len(feature), 3)), probe, feature)


def off_by(stated: Artefact, name: str, rng: np.random.Generator) -> Artefact:
    """The artefact with one dimension (`length_mm`, `diameter_mm`) off by a normal draw of u; None stays None."""
    value = getattr(stated, name)
    off_mm = stated.u_mm * float(rng.standard_normal())
    return stated if value is None else replace(stated, **{name: value + off_mm})


def needs_uncertainty(name: str, fit: bool, u: float | None, path: Path) -> None:
    """What is fitted needs an uncertainty to be fitted within. Raises UlnaInputError."""
    if fit and not u:
        raise UlnaInputError(
            f"{path}: key 'artefact.{name}.fit': true, but its uncertainty u is not stated; expected the standard "
            "uncertainty that it may move within. Add u, or remove the key."
        )


def missing(kind: type[Kind], owed: Mapping[str, str]) -> list[str]:
    """What a kind has not got of what it owes, in words; owed: attribute → what it is."""
    name = getattr(kind, "name", kind.__name__)
    abstract: frozenset[str] = getattr(kind, "__abstractmethods__", frozenset())
    return [
        f"kind '{name}' lacks {attribute}: {what}"
        for attribute, what in owed.items()
        if not hasattr(kind, attribute) or attribute in abstract
    ]
