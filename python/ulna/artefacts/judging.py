"""What a metrologist reads of an artefact, and what it is read from."""

from __future__ import annotations

from dataclasses import dataclass

from ulna.ground.arrays import F64, I64


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
    turned: F64 | None = None
    """(N, 3, 3) from the probe's frame to the base frame; of kinds whose rows say how a target was turned."""


@dataclass(frozen=True)
class Errors:
    """The single errors of one quantity, each with the placement that it belongs to."""

    value_mm: F64
    code: I64
