"""What an arm carries beside its own masses: loads that have names. mm and kg.

A load hangs on the last joint, and its centre is told as that of the last joint's own mass is: in the frame after the
last link, which is the probe's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from ulna.formats.models import Strict
from ulna.formats.names import check_name
from ulna.formats.units import Units
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

NOTHING_CARRIED = "none"
"""What is said of readings with no load; no load can be called so."""

SAME = 1e-9
"""Numbers that differ by a smaller part are one number, written in two units."""


class PayloadTable(Strict):
    """A load that the arm may carry beside its own masses; for compliance."""

    mass: Annotated[float, Field(ge=0, le=1e6)]
    """kg"""
    centre: Annotated[list[float], Field(min_length=3, max_length=3)]
    """The centre of that mass in the frame after the last link (the probe's), in the file's length unit."""


@dataclass(frozen=True)
class Payload:
    """A load that an arm may carry beside its own masses."""

    mass_kg: float
    centre_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Of that mass, in the frame after the last link: the probe's."""

    @property
    def numbers(self) -> F64:
        """(4,) as the core takes it: kg, and x, y, z in mm."""
        return np.array([self.mass_kg, *self.centre_mm], dtype=np.float64)

    def is_like(self, other: Payload) -> bool:
        """Whether it is the same load, but for rounding."""
        return bool(np.allclose(self.numbers, other.numbers, rtol=SAME, atol=SAME))


def payloads_of(tables: Mapping[str, PayloadTable] | None, units: Units, path: Path) -> dict[str, Payload]:
    """By name. Raises UlnaInputError for a name that cannot be one."""
    found: dict[str, Payload] = {}
    for name, table in (tables or {}).items():
        check_name(name, f"payload.{name}", path)
        if name == NOTHING_CARRIED:
            raise UlnaInputError(
                f"{path}: key 'payload.{name}': '{NOTHING_CARRIED}' is what readings say that were taken with no load; "
                "expected another name of a load. Rename it."
            )
        x, y, z = (value * units.mm for value in table.centre)
        found[name] = Payload(table.mass, (x, y, z))
    return found


def joined_payloads(own: Mapping[str, Payload], more: Mapping[str, Payload], path: Path) -> dict[str, Payload]:
    """Those of an arm and of a study (path) that uses it. Raises UlnaInputError where one name means two loads."""
    for name in own.keys() & more.keys():
        if not own[name].is_like(more[name]):
            raise UlnaInputError(
                f"{path}: key 'payload.{name}': got {more[name].mass_kg:g} kg at {_at(more[name])} mm, but the arm "
                f"file says {own[name].mass_kg:g} kg at {_at(own[name])} mm; expected one load of that name. Rename or "
                "correct one of them."
            )
    return {**more, **own}


def named_loads(loads: F64, known: Mapping[str, Payload]) -> list[str]:
    """The names of (N, 4) loads, of those that are known."""
    names = {tuple(each.numbers.tolist()): name for name, each in known.items()}
    # two loads of the same numbers are one to the arm; one of no mass is none
    return [NOTHING_CARRIED if not load[0] else names.get(tuple(load), "") for load in loads.tolist()]


def payload_documents(known: Mapping[str, Payload]) -> dict[str, Any]:
    """With the keys of an arm file, in kg and mm."""
    return {name: {"mass": each.mass_kg, "centre": list(each.centre_mm)} for name, each in known.items()}


def _at(payload: Payload) -> str:
    return ", ".join(f"{value:g}" for value in payload.centre_mm)
