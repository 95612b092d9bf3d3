"""What files state of an arm at work: how it errs, how far it turns, where."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Discriminator, Field, Tag

from ulna.arm.arm import Arm
from ulna.formats.models import Strict
from ulna.formats.numbers import Amount, Positive
from ulna.formats.units import Units
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


def encoder_of(given: float | list[float], arm: Arm, units: Units, path: Path) -> F64:
    """(n,) rad, of prismatic joints mm. Raises UlnaInputError."""
    each = one_per_joint(given, arm, "noise.encoder", path, "in the unit of angles or of lengths, as it reads")
    if any(each) and not all(each):
        raise UlnaInputError(
            f"{path}: key 'noise.encoder': got 0 for joint {each.index(0.0) + 1}, but noise for others; expected none "
            "at all or more than 0 for each: a study cannot state a single joint as exact. Correct it."
        )
    return np.array(each, dtype=np.float64) * arm.each(units.rad, units.mm)


def travel_of(table: TravelTable | None, arm: Arm, units: Units, path: Path) -> F64 | None:
    """(n, 2) rad, within the arm's limits. Raises UlnaInputError."""
    if table is None:
        return None
    check_alike(len(table.limits) == 1, arm, "travel.limits", path, "a pair of lengths")
    pairs = table.limits * arm.n if len(table.limits) == 1 else table.limits
    if len(pairs) != arm.n:
        raise UlnaInputError(
            f"{path}: key 'travel.limits': got {len(pairs)} pairs, expected one, or {arm.n}: one per joint of arm "
            f"'{arm.name}'. Correct it."
        )
    travel_rad = np.array(pairs) * arm.each(units.rad, units.mm)[:, None]
    for k, ((low, high), joint) in enumerate(zip(travel_rad.tolist(), arm.joints, strict=True), start=1):
        if not low < high:
            raise UlnaInputError(
                f"{path}: key 'travel.limits': got {pairs[k - 1]} for joint {k}, expected the lower limit first. Swap "
                "them."
            )
        own = joint.limits_rad
        if own is not None and (low < own[0] - 1e-9 or high > own[1] + 1e-9):
            raise UlnaInputError(
                f"{path}: key 'travel.limits': got {low:g} to {high:g} {joint.unit} for joint {k}, but the arm "
                f"file's limits are {own[0]:g} to {own[1]:g} {joint.unit}; expected a travel within them. "
                "Correct one of them."
            )
    return travel_rad


def volume_of(
    table: VolumeTable | None, units: Units, path: Path, key: str = "volume"
) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
    """Corners of a box, mm. Raises UlnaInputError."""
    if table is None:
        return None
    (x, y, z), (right, back, top) = table.low, table.high
    if not (x < right and y < back and z < top):
        raise UlnaInputError(
            f"{path}: key '{key}': got low {table.low} and high {table.high}; expected every coordinate of low below "
            "that of high. Swap or correct them."
        )
    mm = units.mm
    return (x * mm, y * mm, z * mm), (right * mm, back * mm, top * mm)


def check_alike(alike: bool, arm: Arm, key: str, path: Path, of_slides: str) -> None:
    """One number is not said of joints that turn and of joints that slide. Raises UlnaInputError."""
    if alike and arm.slides.any() and not arm.slides.all():
        number = int(np.argmax(arm.slides)) + 1
        raise UlnaInputError(
            f"{path}: key '{key}': got one for all joints, but joint {number} of arm '{arm.name}' is prismatic and the "
            f"others are not; expected {arm.n}, one per joint: of joint {number} {of_slides}. Write them."
        )


def one_per_joint(given: float | list[float], arm: Arm, key: str, path: Path, of_slides: str = "") -> list[float]:
    """(n,) of one number or one for each joint, in the file's units. of_slides: what is said of one that slides; empty:
    it has no such number. Raises UlnaInputError."""
    if of_slides:
        check_alike(not isinstance(given, list), arm, key, path, of_slides)
    elif arm.slides.any():
        raise UlnaInputError(
            f"{path}: key '{key}': joint {int(np.argmax(arm.slides)) + 1} of arm '{arm.name}' is prismatic and has no "
            "turns to be counted; expected no such key. Remove it."
        )
    each = given if isinstance(given, list) else [given] * arm.n
    if len(each) != arm.n:
        raise UlnaInputError(
            f"{path}: key '{key}': got {len(each)} numbers, expected one, or {arm.n}: one per joint of arm "
            f"'{arm.name}'. Correct it."
        )
    return each


class TravelTable(Strict):
    """How far joints turn, where the arm file does not say it or they shall turn less."""

    limits: Annotated[list[Annotated[list[float], Field(min_length=2, max_length=2)]], Field(min_length=1)]
    """Lowest and highest encoder angle, one pair for all joints or one per joint."""


class VolumeTable(Strict):
    """The box, in the base frame, in which artefacts are touched."""

    low: Annotated[list[float], Field(min_length=3, max_length=3)]
    high: Annotated[list[float], Field(min_length=3, max_length=3)]


def each_kind(value: Any) -> str:
    return "<each>" if isinstance(value, list) else "<all>"


PositiveEach = Annotated[
    Annotated[Positive, Tag("<all>")] | Annotated[list[Positive], Tag("<each>")], Discriminator(each_kind)
]


AmountEach = Annotated[
    Annotated[Amount, Tag("<all>")] | Annotated[list[Amount], Tag("<each>")], Discriminator(each_kind)
]


Box = tuple[tuple[float, float, float], tuple[float, float, float]]
