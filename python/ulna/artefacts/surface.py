"""What kinds have in common that are touched on their surface with the ball of the tip."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: touches of surfaces are spread by the golden ratio and by its relative in two dimensions, so that none are near
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
PLASTIC = 1.324717957244746


class Surface(Kind):
    """A kind that is touched on its surface: no features, one number a touch."""

    named, scattered = False, True
    residual_columns = ("distance_mm",)
    touches = 20
    least_planned: ClassVar[int] = 4
    """Touches of it in a plan: three only say where it is."""

    def check_planned(self, artefact: Artefact, touches: int, label: str) -> None:
        """A few touches only say where it is. Raises UlnaInputError."""
        if touches < self.least_planned:
            raise UlnaInputError(
                f"{label}: {touches} touches of a {self.name} tell nothing, for its place is unknown; expected "
                f"{self.least_planned} or more. Raise touches."
            )


def check_known(artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
    """Whether the diameters of the balls of the probes (indices) are known. Raises UlnaInputError."""
    for k in used:
        name, probe = list(arm.probes.items())[k]
        if probe.ball_mm is None:
            raise UlnaInputError(
                f"{label}: artefact '{artefact.name}' is touched on its surface with probe '{name}', whose ball has no "
                f"diameter in arm '{arm.name}'; expected probe.{name}.ball, in the arm file's length unit. Add it."
            )


def check_fitting(artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
    """Whether the balls of the probes (indices) go into a hollow. Raises UlnaInputError."""
    for k in used if artefact.inside else ():
        name, probe = list(arm.probes.items())[k]
        if (probe.ball_mm or 0.0) >= (artefact.diameter_mm or 0.0):
            raise UlnaInputError(
                f"{label}: artefact '{artefact.name}' is a hollow of {artefact.diameter_mm:g} mm, but the ball of "
                f"probe '{name}' has {probe.ball_mm:g} mm; expected a smaller ball. Correct the diameters, or remove "
                "inside."
            )


def of_placements(
    tips: Tips, fewest: int, judge: Callable[[F64, F64], Sequence[float] | None], names: Sequence[str]
) -> dict[str, Errors]:
    """The errors, called `names`, that `judge` finds of the ball centres (n, 3) and diameters (n,) of each placement
    touched `fewest` times or more; None: these touches give no surface."""
    rows: list[Sequence[float]] = []
    codes: list[int] = []
    for number in range(int(tips.code.max()) + 1 if len(tips.code) else 0):
        own = tips.code == number
        found = judge(tips.first_mm[own], tips.ball_mm[own]) if own.sum() >= fewest else None
        if found is not None:
            codes.append(number)
            rows.append(found)
    if not rows:
        return {}
    columns = np.array(rows, dtype=np.float64).T
    return {name: Errors(column, np.array(codes, dtype=np.int64)) for name, column in zip(names, columns, strict=True)}
