"""`link-expansion`: links that grow with temperature.

a_i, d_i (of the last joint: the tip) grow by the factor 1 + expansion_i (T_i - 20 °C)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ulna.arm.conditions import TEMPERATURE
from ulna.arm.effects.effect import Effect, Row
from ulna.formats.models import Strict
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError

#: no material grows by a hundredth for each kelvin
MOST_PER_K = 0.01


class ExpansionKeys(Strict):
    """Of a joint's table."""

    expansion: float | None = None
    """Of the link (of the last joint: of the probe), 1/K; lengths are those at 20 °C."""


class Expansion(Effect):
    """Thermal expansion of links."""

    name = "link-expansion"
    table = ExpansionKeys
    suffixes, examples = ("expansion",), ("expansion",)
    unit, drawn = "1/K", 3e-5  # no engineering material grows by more
    needs = TEMPERATURE
    of_turn = False
    whose, does = "links", "grow with temperature"
    words = "the growth of its links with temperature"
    causes = MappingProxyType({"temperature-still": "a temperature that does not change"})
    left_out = "links that grow with temperature"

    def has(self, own: ExpansionOfJoint) -> bool:
        """Any number, zero too."""
        return own.expansion_per_k is not None

    def zero(self, own: ExpansionOfJoint, orders: Sequence[int]) -> dict[str, Any]:
        """A link that does not grow."""
        return {"expansion_per_k": own.expansion_per_k or 0.0}

    def none(self) -> dict[str, Any]:
        """Nothing said."""
        return {"expansion_per_k": None}

    def read(self, table: ExpansionKeys, key: str, units: Units, path: Path) -> dict[str, Any]:
        """1/K whatever the file's units. Raises UlnaInputError for what must be in ppm/K."""
        if table.expansion is not None and abs(table.expansion) > MOST_PER_K:
            raise UlnaInputError(
                f"{path}: key '{key}.expansion': got {table.expansion:g} 1/K; expected a number such as 11.5e-6. Is it "
                "in ppm/K? Multiply it by 1e-6."
            )
        return {"expansion_per_k": table.expansion}

    def written(self, own: ExpansionOfJoint) -> dict[str, Any]:
        """One number."""
        return {} if own.expansion_per_k is None else {"expansion": own.expansion_per_k}

    def for_core(
        self, joints: Sequence[ExpansionOfJoint], gravity: Sequence[float], payload_kg: float = 0.0
    ) -> dict[str, Any]:
        """One number a joint."""
        return {"expansion_per_k": np.array([own.expansion_per_k or 0.0 for own in joints])}

    def taken(self, own: ExpansionOfJoint, values: Mapping[str, float]) -> dict[str, Any]:
        """One number."""
        return {"expansion_per_k": values["expansion"]}


@dataclass(frozen=True)
class ExpansionOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = Expansion()
    expansion_per_k: float | None = None
    """Of the link after the joint; of the last joint, of the probe."""
