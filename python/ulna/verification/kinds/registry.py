"""Which kinds of acceptance tests there are: one row each."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ulna.ground.errors import UlnaInputError, nearest
from ulna.verification.kinds.articulation import ARTICULATION
from ulna.verification.kinds.effective_diameter import EFFECTIVE_DIAMETER
from ulna.verification.kinds.kind import TestKind
from ulna.verification.kinds.length import LENGTH
from ulna.verification.kinds.single_point import SINGLE_POINT
from ulna.verification.kinds.sphere import SPHERE
from ulna.verification.kinds.volumetric import VOLUMETRIC


def by_name(kinds: Iterable[TestKind[Any]]) -> dict[str, TestKind[Any]]:
    """Name → kind. Raises TypeError where two have one name."""
    found: dict[str, TestKind[Any]] = {}
    for kind in kinds:
        if kind.name in found:
            tables = f"{found[kind.name].table.__name__} and {kind.table.__name__}"
            raise TypeError(f"acceptance test '{kind.name}': {tables} are both called so; give one another name")
        found[kind.name] = kind
    return found


KINDS = by_name(
    [
        SPHERE,
        ARTICULATION,
        LENGTH,
        EFFECTIVE_DIAMETER,
        SINGLE_POINT,
        VOLUMETRIC,
    ]
)


def kind_of(name: str) -> TestKind[Any]:
    """By name. Raises UlnaInputError for one that nobody knows."""
    if name not in KINDS:
        raise UlnaInputError(
            f"an acceptance test of kind '{name}': this Ulna does not know it.{nearest(name, KINDS)} Correct it, or "
            "update Ulna."
        )
    return KINDS[name]


LENGTHS = tuple(name for name, kind in KINDS.items() if kind.length_errors)
"""Kinds of tests whose first figure is of length errors."""
