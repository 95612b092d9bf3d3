"""What an effect beyond geometry owes: all that anybody asks about it. One file each, one row in
`ulna.arm.effects.effects`.

Nobody outside this room asks which effects an arm has: whoever needs to know something asks the arm's effects for it.
What an effect lacks is named by `missing`, and the contract suite goes through every row.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

from ulna.arm.conditions import Condition
from ulna.formats.models import Strict
from ulna.formats.units import Units


class Effect(ABC):
    """One effect. What has no general answer is abstract; the rest is the answer of most effects.

    `own` is what one joint has of it: the fields of `ulna.Effects` that its `OfJoint` declares. Changes are such fields
    by name.
    """

    name: ClassVar[str]
    """By which a study asks for it."""
    table: ClassVar[type[Strict]]
    """Its keys of a joint table in an arm file."""
    suffixes: ClassVar[tuple[str, ...]]
    """Last parts of its parameters' names, or shell-style patterns of them."""
    examples: ClassVar[tuple[str, ...]]
    """Such parts."""
    unit: ClassVar[str]
    """Of its parameters, as the core calls it."""
    drawn: ClassVar[float]
    """What may be of a parameter before anybody has measured."""
    prior_u: ClassVar[float | None] = None
    """Standard uncertainty of a parameter where the study states none; None: nothing is known beforehand."""
    of_first: ClassVar[bool] = False
    """Whether only the first joint has it: where the arm stands, of which no length depends."""
    of_turn: ClassVar[bool] = True
    """Whether only a joint that turns has it; one that slides has none of its parameters."""
    needs: ClassVar[Condition | None] = None
    """On which condition of a pose it depends."""
    whose: ClassVar[str] = "joints"
    """What of an arm has it: its joints, or its links."""
    does: ClassVar[str]
    """And what they do, after `whose`: "grow with temperature"."""
    words: ClassVar[str]
    """What is not carried by formats that have no place for it: "the growth of its links with temperature"."""
    causes: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Why readings may not determine its parameters, as the core calls it → in words."""
    left_out: ClassVar[str]
    """What figures do not cover of an arm without it: "links that grow with temperature"."""

    @property
    def patterns(self) -> tuple[str, ...]:
        """Shell-style patterns of its parameters' names."""
        return tuple(f"joint.*.{suffix}" for suffix in self.suffixes)

    @abstractmethod
    def has(self, own: Any) -> bool:
        """Whether a joint has it."""

    @abstractmethod
    def zero(self, own: Any, orders: Sequence[int]) -> dict[str, Any]:
        """Changes: zero of it where there is none yet. orders: of harmonics, which the study asks for."""

    @abstractmethod
    def none(self) -> dict[str, Any]:
        """Changes: without it; what is known from the design stays."""

    @abstractmethod
    def read(self, table: Any, key: str, units: Units, path: Path) -> dict[str, Any]:
        """Changes: what a joint's table says, in mm and rad. key: of the table. Raises UlnaInputError."""

    @abstractmethod
    def written(self, own: Any) -> dict[str, Any]:
        """Keys of a joint's table, in mm and rad."""

    @abstractmethod
    def for_core(self, joints: Sequence[Any], gravity: Sequence[float], payload_kg: float = 0.0) -> dict[str, Any]:
        """Its arrays in `_core.Arm.with_effects`: a joint without it counts as having zero of it."""

    @abstractmethod
    def taken(self, own: Any, values: Mapping[str, float]) -> dict[str, Any]:
        """Changes: other values of its parameters, by the last parts of their names."""

    def judged(self, orders: Sequence[int]) -> list[tuple[int | None, tuple[str, ...]]]:
        """What is judged by readings left out: the whole of it (None), or a part by its number, with the patterns of
        what belongs to it. orders: of harmonics."""
        return [(None, self.patterns)]

    def ratios(self, joints: Sequence[Any]) -> list[tuple[int, int, float]]:
        """What of it is a constant share of other encoders in a joint's turn: (joint, encoder, ratio), counted from 0.
        A picture of the arm has that; what else an effect does is too small to be seen in one."""
        return []

    def check_joints(self, joints: Sequence[Any], path: Path, payload_kg: float = 0.0) -> None:
        """Whether it makes sense in an arm file with such joints. Raises UlnaInputError."""
        return

    def check_modified(self, table: Any, key: str, path: Path) -> None:
        """Whether a joint's table in Craig's form can say what it says. Raises UlnaInputError."""
        return

    def check_asked(self, joints: Sequence[Any], arm: str, label: str, payload_kg: float = 0.0) -> None:
        """Whether a study can ask for it of an arm with such joints; label: of the study. Raises UlnaInputError."""
        return

    def given(self, joints: Sequence[Any], gravity: Sequence[float]) -> list[tuple[str, float, str]]:
        """What else is needed to compute a tip, beside its parameters: (name, value, unit)."""
        return []

    def __repr__(self) -> str:
        return f"effect {self.name}"


@dataclass(frozen=True)
class Row:
    """Base of what a joint has of an effect: its fields of `ulna.Effects`."""

    effect: ClassVar[Effect]
