"""`compliance`: joints that give way to the weight of what they carry.

compliance_i m_i   added to each turn, with m_i the moment of gravity about axis i on all that the joint carries, N m:
                   the links behind it, and the load of the reading
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from ulna.arm.conditions import PAYLOAD
from ulna.arm.effects.effect import Effect, Row
from ulna.formats.models import Strict
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError


class ComplianceKeys(Strict):
    """Of a joint's table."""

    compliance: float | None = None
    """How far the joint gives way to gravity's moment about its axis, in the file's angle unit for each N m."""
    mass: Annotated[float, Field(ge=0, le=1e6)] | None = None
    """Of the link, kg; for compliance."""
    centre: Annotated[list[float], Field(min_length=3, max_length=3)] | None = None
    """The centre of that mass in the frame after the link, in the file's length unit."""


class Compliance(Effect):
    """Compliance of joints."""

    name = "compliance"
    table = ComplianceKeys
    suffixes, examples = ("compliance",), ("compliance",)
    unit, drawn = "rad/(N m)", 1e-3  # a joint that gives way by more is broken
    needs = PAYLOAD
    does = "give way to what they carry"
    words = "the compliance of its joints"
    causes = MappingProxyType({"no-moment": "gravity along an axis"})
    left_out = "joints that give way under load"

    def has(self, own: ComplianceOfJoint) -> bool:
        """Any number, zero too; a mass alone is none."""
        return own.compliance_rad_per_nm is not None

    def zero(self, own: ComplianceOfJoint, orders: Sequence[int]) -> dict[str, Any]:
        """A joint that does not give way."""
        return {"compliance_rad_per_nm": own.compliance_rad_per_nm or 0.0}

    def none(self) -> dict[str, Any]:
        """The masses stay, which are known from the design."""
        return {"compliance_rad_per_nm": None}

    def read(self, table: ComplianceKeys, key: str, units: Units, path: Path) -> dict[str, Any]:
        """With the mass of the link, and where it is."""
        x, y, z = table.centre or (0.0, 0.0, 0.0)
        return {
            "compliance_rad_per_nm": None if table.compliance is None else table.compliance * units.rad,
            "mass_kg": table.mass or 0.0,
            "centre_mm": (x * units.mm, y * units.mm, z * units.mm),
        }

    def written(self, own: ComplianceOfJoint) -> dict[str, Any]:
        """The mass too, where there is one."""
        found: dict[str, Any] = {}
        if own.compliance_rad_per_nm is not None:
            found["compliance"] = own.compliance_rad_per_nm
        if own.mass_kg:
            found |= {"mass": own.mass_kg, "centre": list(own.centre_mm)}
        return found

    def for_core(
        self, joints: Sequence[ComplianceOfJoint], gravity: Sequence[float], payload_kg: float = 0.0
    ) -> dict[str, Any]:
        """With the masses of all joints, that of the heaviest load, and the direction of gravity."""
        return {
            "compliance_rad_per_nm": np.array([own.compliance_rad_per_nm or 0.0 for own in joints]),
            "masses_kg": np.array([own.mass_kg for own in joints]),
            "centres_mm": np.array([own.centre_mm for own in joints], dtype=np.float64),
            "gravity": np.array([float(g) for g in gravity]),
            "payload_kg": np.array([payload_kg]),
        }

    def taken(self, own: ComplianceOfJoint, values: Mapping[str, float]) -> dict[str, Any]:
        """One number."""
        return {"compliance_rad_per_nm": values["compliance"]}

    def check_joints(self, joints: Sequence[ComplianceOfJoint], path: Path, payload_kg: float = 0.0) -> None:
        """Joints that give way give way to something."""
        gives = next((k for k, own in enumerate(joints, 1) if own.compliance_rad_per_nm), None)
        if gives is not None and not payload_kg and not any(own.mass_kg for own in joints):
            raise UlnaInputError(
                f"{path}: key 'joint.{gives}.compliance': a joint gives way to the weight of its links, but no joint "
                "has a mass, and there is no load; expected mass (kg) and centre of each. Add them, or remove the key."
            )

    def check_modified(self, table: ComplianceKeys, key: str, path: Path) -> None:
        """No mass: where it is, is told in a frame that such a table has not."""
        if table.mass:
            raise UlnaInputError(
                f"{path}: key '{key}.mass': a centre of mass is told in the frame after a link, which a modified "
                'table does not have; expected masses with convention = "dh" only. Write the arm in that form.'
            )

    def check_asked(self, joints: Sequence[ComplianceOfJoint], arm: str, label: str, payload_kg: float = 0.0) -> None:
        """There is a mass."""
        if not payload_kg and not any(own.mass_kg for own in joints):
            raise UlnaInputError(
                f"{label}: key 'fit.extras': 'compliance' is how joints give way to the weight of the links, but no "
                f"joint of arm '{arm}' has a mass; expected mass (kg) and centre in the arm file's joint tables. Add "
                "them: rough ones will do, the compliance takes their scale."
            )

    def given(self, joints: Sequence[ComplianceOfJoint], gravity: Sequence[float]) -> list[tuple[str, float, str]]:
        """Masses, their centres, and where gravity pulls."""
        found: list[tuple[str, float, str]] = []
        for k, own in enumerate(joints, 1):
            found.append((f"joint.{k}.mass", own.mass_kg, "kg"))
            found += [(f"joint.{k}.centre.{axis}", x, "mm") for axis, x in zip("xyz", own.centre_mm, strict=True)]
        return found + [(f"gravity.{axis}", value, "1") for axis, value in zip("xyz", gravity, strict=True)]


@dataclass(frozen=True)
class ComplianceOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = Compliance()
    compliance_rad_per_nm: float | None = None
    """How far the joint gives way to a moment about its axis."""
    mass_kg: float = 0.0
    """Of what moves with the joint up to the next: its link."""
    centre_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """The centre of that mass, in the frame after the link."""
