"""`encoder-harmonics`: encoders whose discs are not centred, or not round.

q_i + Σ_k c_ik cos k q_i + s_ik sin k q_i   in place of each encoder angle q_i
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ulna.arm.effects.effect import Effect, Row
from ulna.formats.models import Strict
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError

#: no encoder's error has a wave as short as this part of a turn
MOST_ORDER = 100
#: more orders than this are judged as one block only: each costs as many fits as there are groups
MOST_ORDERS = 3


class HarmonicsKeys(Strict):
    """Of a joint's table."""

    harmonics: dict[str, float] | None = None
    """Error of the encoder, { c1, s1, c2, s2, … }: q + Σ c_k cos k q + s_k sin k q, in the file's angle unit."""


class Harmonics(Effect):
    """Encoder harmonics."""

    name = "encoder-harmonics"
    table = HarmonicsKeys
    suffixes, examples = ("c[0-9]*", "s[0-9]*"), ("c1", "s1", "c2", "s2")
    unit, drawn = "rad", 0.01
    # over a short travel they would otherwise imitate zero offsets, and each other; ten times what a good encoder
    # shows, and what robots show
    prior_u = 5e-4
    whose, does = "encoders", "are not centred"
    words = "the errors of its encoders (harmonics)"
    left_out = "eccentric encoders"

    def has(self, own: HarmonicsOfJoint) -> bool:
        """Any order."""
        return bool(own.harmonics_rad)

    def zero(self, own: HarmonicsOfJoint, orders: Sequence[int]) -> dict[str, Any]:
        """Of the orders that it has not."""
        return {"harmonics_rad": dict.fromkeys(sorted(orders), (0.0, 0.0)) | dict(own.harmonics_rad)}

    def none(self) -> dict[str, Any]:
        """No order."""
        return {"harmonics_rad": {}}

    def read(self, table: HarmonicsKeys, key: str, units: Units, path: Path) -> dict[str, Any]:
        """Orders ascend, whatever the file's order. Raises UlnaInputError for a name that is none."""
        harmonics: dict[int, list[float]] = {}
        for part, value in (table.harmonics or {}).items():
            match = re.fullmatch(r"([cs])([1-9][0-9]*)", part)
            if match is None or int(match[2]) > MOST_ORDER:
                raise UlnaInputError(
                    f"{path}: key '{key}.harmonics.{part}': expected c1, s1, c2, s2, …: cosine and sine amplitude "
                    f"of an order from 1 to {MOST_ORDER}. Correct it."
                )
            harmonics.setdefault(int(match[2]), [0.0, 0.0])["cs".index(match[1])] = value * units.rad
        return {"harmonics_rad": {order: (c, s) for order, (c, s) in sorted(harmonics.items())}}

    def written(self, own: HarmonicsOfJoint) -> dict[str, Any]:
        """c and s of each order."""
        pairs = own.harmonics_rad.items()
        found = {f"{part}{order}": value for order, cs in pairs for part, value in zip("cs", cs, strict=True)}
        return {"harmonics": found} if found else {}

    def for_core(
        self, joints: Sequence[HarmonicsOfJoint], gravity: Sequence[float], payload_kg: float = 0.0
    ) -> dict[str, Any]:
        """Every joint with the orders of all."""
        orders = sorted({order for own in joints for order in own.harmonics_rad})
        amplitudes = [[own.harmonics_rad.get(order, (0.0, 0.0)) for order in orders] for own in joints]
        return {"orders": np.array(orders, dtype=np.float64), "amplitudes_rad": np.array(amplitudes)}

    def taken(self, own: HarmonicsOfJoint, values: Mapping[str, float]) -> dict[str, Any]:
        """Of all orders that there are values of."""
        orders = sorted({int(suffix[1:]) for suffix in values})
        return {"harmonics_rad": {order: (values[f"c{order}"], values[f"s{order}"]) for order in orders}}

    def judged(self, orders: Sequence[int]) -> list[tuple[int | None, tuple[str, ...]]]:
        """Of a few orders each besides."""
        several = sorted(set(orders))
        each = [(order, (f"joint.*.c{order}", f"joint.*.s{order}")) for order in several]
        return [(None, self.patterns), *(each if 1 < len(several) <= MOST_ORDERS else ())]


@dataclass(frozen=True)
class HarmonicsOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = Harmonics()
    harmonics_rad: Mapping[int, tuple[float, float]] = field(default_factory=dict)
    """Order k → amplitudes (c_k, s_k) of the encoder's error."""
