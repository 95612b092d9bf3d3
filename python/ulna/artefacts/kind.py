"""What a kind of artefact owes: all that anybody asks about it. One file a kind, one row in `ulna.artefacts.kinds`.

Nobody outside this room asks which kind an artefact is of: whoever needs to know something asks the kind for it. What a
kind lacks is named by `missing`, and the contract suite goes through every row.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.dimension import Dimension
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.readings import InputFile, Readings
from ulna.artefacts.tables import StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching
from ulna.ground.arrays import F64


class Kind(ABC):
    """One kind of artefact. What has no general answer is abstract; the rest is the answer of most kinds."""

    name: ClassVar[str]
    """As files say it."""
    table: ClassVar[type[StatedTable]]
    """Of a study file or a plan file."""
    simulated: ClassVar[type[TouchedTable]]
    """Of a simulation file: the same, and how it is touched."""
    lent: ClassVar[str | None] = None
    """The quantity by which a certificate states one, which a study need not write out; None: no single one does."""
    poses: ClassVar[int] = 1
    """How many poses of the arm a row has."""
    named: ClassVar[bool]
    """Whether a row names the feature that was touched."""
    measured_column: ClassVar[str | None] = None
    """Column of a distance that was measured along with the row."""
    turned: ClassVar[bool] = False
    """Whether a row says how a target on the last link was turned."""
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

    def check_noise(self, group: Readings, label: str) -> None:
        """Whether all is stated that its readings need beside the noise of the arm; label: what messages call the
        study. Raises UlnaInputError."""
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

    def seen(
        self, stated: Artefact, true: Artefact, held: F64, axes: F64, rng: np.random.Generator
    ) -> tuple[F64, F64 | None] | None:
        """How an instrument says that a target was turned, (N, 3) rotation vectors, and (N,) their standard
        uncertainty, rad; None where nothing is seen. held: (N, 3, 3) from the probe's frame to the base frame; axes:
        (N, 3, 3) those of the artefact as rows, base frame."""
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
