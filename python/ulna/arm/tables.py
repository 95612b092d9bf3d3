"""The tables of an arm file, `ulna-arm/1`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ulna.arm.frames.modified import Convention
from ulna.arm.joint_file import JointTable
from ulna.arm.payload import PayloadTable
from ulna.formats.models import Strict
from ulna.formats.units import Units


class CartesianTip(Strict):
    """The ball's centre in the frame that turns with the last joint."""

    x: float
    y: float
    z: float


class CylindricalTip(Strict):
    """The same point: x = r cos theta0, y = -r sin theta0, z = h."""

    theta0: float
    r: Annotated[float, Field(ge=0)]
    h: float


def _tip_kind(tip: Any) -> str:
    keys = tip.keys() if isinstance(tip, dict) else vars(tip).keys() if hasattr(tip, "__dict__") else ()
    return "<cylindrical>" if {"theta0", "r", "h"} & set(keys) else "<cartesian>"


Tip = Annotated[
    Annotated[CartesianTip, Tag("<cartesian>")] | Annotated[CylindricalTip, Tag("<cylindrical>")],
    Discriminator(_tip_kind),
]


class ProbeTable(Strict):
    """One probe that the arm can carry."""

    tip: Tip
    ball: Annotated[float, Field(gt=0)] | None = None
    """Diameter of the ball; needed where a surface is touched."""


class ArmFile(Strict):
    """An articulated arm: `ulna-arm/1`."""

    format: Literal["ulna-arm/1"]
    name: str | None = None
    units: Units
    convention: Convention = "dh"
    """In the joint tables alpha and a stand after the joint ("dh") or before it ("modified-dh", Craig)."""
    full_last_link: bool = False
    """The last joint has a link of its own, to whose end the probes are fixed: four parameters more than needed."""
    gravity: Annotated[list[float], Field(min_length=3, max_length=3)] | None = None
    """Where gravity pulls, in the base frame; down along axis 1, [0, 0, -1], where it is not given. For compliance."""
    payload: dict[str, PayloadTable] | None = None
    """What the arm may carry beside its own masses, by name; readings say which. For compliance."""
    joint: Annotated[list[JointTable], Field(min_length=2)]
    """One table per encoder, from the base to the probe."""
    probe: Annotated[dict[str, ProbeTable], Field(min_length=1)]
    """By name. The order gives the order of the parameters."""
