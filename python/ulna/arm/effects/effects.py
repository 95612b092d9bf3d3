"""What joints do beyond their geometry: one row each. All of it is off until an arm has it.

    turn_i = sign_i (q_i + what the encoder adds) - theta0_i + what the bearing gives way
    a_i, d_i (of the last joint: the tip) times how much the link grows

Names of the parameters are `joint.3.c1`, `joint.3.expansion` and so on; each effect's file says its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

from ulna.arm.conditions import Condition
from ulna.arm.effects.backlash import BacklashOfJoint
from ulna.arm.effects.base import BaseOffsetOfJoint, BaseTiltOfJoint
from ulna.arm.effects.compliance import ComplianceOfJoint
from ulna.arm.effects.coupling import CouplingOfJoint
from ulna.arm.effects.effect import Effect, Row
from ulna.arm.effects.expansion import ExpansionOfJoint
from ulna.arm.effects.harmonics import HarmonicsOfJoint
from ulna.formats.models import Strict
from ulna.ground.errors import UlnaInputError, nearest


@dataclass(frozen=True)
class Effects(
    # a row each; dataclasses take the fields of the last one first
    BaseOffsetOfJoint,
    BaseTiltOfJoint,
    CouplingOfJoint,
    BacklashOfJoint,
    ComplianceOfJoint,
    ExpansionOfJoint,
    HarmonicsOfJoint,
):
    """Of one joint. What is None or empty the joint does not have."""


EFFECTS: dict[str, Effect] = {row.effect.name: row.effect for row in cast(list[type[Row]], Effects.__bases__[::-1])}
"""By name, in the order in which messages list them."""

if TYPE_CHECKING:
    Extra: TypeAlias = str
else:
    Extra = Literal[tuple(EFFECTS)]
    """The blocks that a fit may be asked for."""

EXTRAS: tuple[Extra, ...] = tuple(EFFECTS)

NONE = Effects()


def joint_tables() -> tuple[type[Strict], ...]:
    """The keys of a joint's table that each effect has."""
    return tuple(effect.table for effect in EFFECTS.values())


def effects_of(joints: Sequence[Effects]) -> list[Effect]:
    """Those that an arm of such joints has."""
    return [effect for effect in EFFECTS.values() if any(effect.has(own) for own in joints)]


def needs_of(joints: Sequence[Effects]) -> dict[Condition, Effect]:
    """On which conditions of a pose an arm of such joints depends, each with the effect that asks for it."""
    return {effect.needs: effect for effect in effects_of(joints) if effect.needs is not None}


def effect_named(name: str) -> Effect:
    """Raises UlnaInputError where there is none."""
    if name not in EFFECTS:
        raise UlnaInputError(f"there is no effect {name!r}; expected {', '.join(EFFECTS)}.{nearest(name, EFFECTS)}")
    return EFFECTS[name]


def with_extras(joints: Sequence[Effects], extras: Sequence[str], orders: Sequence[int]) -> list[Effects]:
    """The joints' effects with zero of what `extras` asks for, where there is none of it yet; orders: of harmonics."""
    found = list(joints)
    for effect in map(effect_named, extras):
        for joint in range(1 if effect.of_first else len(found)):
            found[joint] = replace(found[joint], **effect.zero(found[joint], orders))
    return found


def without(own: Effects) -> Effects:
    """None of them; what is known from the design stays."""
    return replace(own, **_together(effect.none() for effect in EFFECTS.values()))


@lru_cache(maxsize=4096)  # every fit asks it of every parameter, several times
def extra_of(parameter: str) -> Extra | None:
    """The block that a parameter belongs to, by its name."""
    own = (name for name, effect in EFFECTS.items() if any(fnmatchcase(parameter, p) for p in effect.patterns))
    return next(own, None)


def for_core(
    joints: Sequence[Effects], gravity: Sequence[float], payload_kg: float = 0.0
) -> list[tuple[str, dict[str, Any]]]:
    """The argument of `_core.Arm.with_effects`. payload_kg: mass of the heaviest load."""
    return [(effect.name, effect.for_core(joints, gravity, payload_kg)) for effect in effects_of(joints)]


def from_core(joints: Sequence[Effects], values: dict[str, float]) -> list[Effects]:
    """The joints' effects with other values of their parameters, by name."""
    of_joint: list[dict[str, dict[str, float]]] = [{} for _ in joints]
    for parameter, value in values.items():
        _, number, suffix = parameter.split(".", 2)
        of_joint[int(number) - 1].setdefault(str(extra_of(parameter)), {})[suffix] = value
    return [
        replace(own, **_together(EFFECTS[name].taken(own, values) for name, values in found.items()))
        for own, found in zip(joints, of_joint, strict=True)
    ]


def _together(changes: Iterable[dict[str, Any]]) -> dict[str, Any]:
    return {field: value for each in changes for field, value in each.items()}
