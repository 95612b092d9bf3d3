"""Joint tables of an arm file: geometry, and what a joint does beyond it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from ulna.arm.effects.effects import EFFECTS, Effects, joint_tables
from ulna.arm.joint import Joint, JointType
from ulna.arm.prismatic import check_prismatic
from ulna.formats.models import Strict
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError


def _no_truth(value: Any) -> Any:
    """Python takes true for 1."""
    if isinstance(value, bool):
        raise PydanticCustomError("sign", "1, -1 or 0")
    return value


class GeometryTable(Strict):
    """One joint, from the base to the probe: `turn = sign * encoder - theta0`, then the link to the next axis."""

    theta0: float | None = None
    """Zero offset. Required, except of the last joint, which carries the probe and has no geometry of its own."""
    alpha: float | None = None
    """Twist to the next axis. Required, except of the last joint."""
    a: float | None = None
    """Length of the link. Required, except of the last joint."""
    d: float | None = None
    """Offset along the axis. Required of a DH joint, except the last."""
    beta: float | None = None
    """Required of a Hayati joint, instead of d."""
    sign: Annotated[Literal[1, -1, 0], BeforeValidator(_no_truth)] = 1
    """0: nobody knows which way the encoder counts; a calibration finds it."""
    model: Literal["dh", "hayati"] = "dh"
    type: JointType = "rotary"
    """prismatic: it does not turn, it slides along its axis; its encoder reads lengths."""
    name: str | None = None
    limits: Annotated[list[float], Field(min_length=2, max_length=2)] | None = None
    """Lowest and highest encoder angle, in the file's angle unit; of a prismatic joint in its length unit. Required of
    such a joint."""
    endless: bool = False
    """It turns on and on, and its encoder counts the turns: such a joint has no limits."""
    counts_per_turn: Annotated[float, Field(gt=0)] | None = None
    """Needed for readings in counts."""


if TYPE_CHECKING:
    JointTable = GeometryTable
else:
    # models take the fields of the last base first: the keys of geometry, then those of each effect
    class JointTable(*reversed(joint_tables()), GeometryTable):
        """One joint, from the base to the probe: `turn = sign * encoder - theta0`, then the link to the next axis."""


def joint_of(table: JointTable, number: int, bare: bool, units: Units, path: Path) -> Joint:
    """A joint in mm and rad. bare: the last joint of an arm without a full last link. Raises UlnaInputError."""
    _check_geometry(table, number, bare, path)
    if table.limits is not None and not table.limits[0] < table.limits[1]:
        raise UlnaInputError(
            f"{path}: key 'joint.{number}.limits': got {table.limits}, expected the lower limit first. Swap them."
        )
    if table.limits is not None and table.endless:
        raise UlnaInputError(
            f"{path}: key 'joint.{number}.endless': got true, but the joint has limits, {table.limits}; expected one "
            "of them. Remove the limits if it turns on and on, else endless."
        )
    beyond = Effects(**_beyond(table, number, units, path))
    slides = table.type == "prismatic"
    if slides:
        check_prismatic(table, beyond, number, path)
    unit = units.mm if slides else units.rad
    return Joint(
        theta0_rad=(table.theta0 or 0.0) * units.rad,
        alpha_rad=(table.alpha or 0.0) * units.rad,
        a_mm=(table.a or 0.0) * units.mm,
        d_mm=(table.d or 0.0) * units.mm,
        beta_rad=(table.beta or 0.0) * units.rad,
        sign=table.sign,
        model=table.model,
        name=table.name,
        limits_rad=None if table.limits is None else (table.limits[0] * unit, table.limits[1] * unit),
        endless=table.endless,
        counts_per_turn=table.counts_per_turn,
        effects=beyond,
        type=table.type,
    )


def _beyond(table: JointTable, number: int, units: Units, path: Path) -> dict[str, Any]:
    said: dict[str, Any] = {}
    for effect in EFFECTS.values():
        said |= effect.read(table, f"joint.{number}", units, path)
    return said


def _check_geometry(table: JointTable, number: int, bare: bool, path: Path) -> None:
    geometry = {"theta0": table.theta0, "alpha": table.alpha, "a": table.a, "d": table.d, "beta": table.beta}
    missing, foreign = ("d", "beta") if table.model == "dh" else ("beta", "d")
    for key, value in geometry.items():
        name = f"joint.{number}.{key}"
        if bare and value:
            raise UlnaInputError(
                f"{path}: key '{name}': got {value:g}, but the last joint has no geometry of its own: it is part of "
                "the probe's tip. Remove the key and turn the tip by theta0 instead (tip = { theta0, r, h }), or state "
                "a model with a full last link: full_last_link = true."
            )
        if not bare and key == foreign and value:
            other = "hayati" if key == "beta" else "dh"
            raise UlnaInputError(
                f"{path}: key '{name}': got {value:g}, but a joint of model '{table.model}' has '{missing}' instead. "
                f'Remove the key or set model = "{other}".'
            )
        if not bare and key != foreign and value is None:
            raise UlnaInputError(
                f"{path}: key '{name}' is missing; expected theta0, alpha, a and {missing} of every joint but the "
                "last. Add it (0 where the drawing says nothing)."
            )


def joint_document(joint: Joint, bare: bool) -> dict[str, Any]:
    """The joint with the keys of an arm file, in mm and rad."""
    table: dict[str, Any] = {} if joint.name is None else {"name": joint.name}
    if not bare:
        table |= {"theta0": joint.theta0_rad, "alpha": joint.alpha_rad, "a": joint.a_mm}
        table |= {"beta": joint.beta_rad} if joint.model == "hayati" else {"d": joint.d_mm}
    table |= {"sign": joint.sign}
    if joint.model != "dh":
        table |= {"model": joint.model}
    if joint.slides:
        table |= {"type": joint.type}
    if joint.limits_rad is not None:
        table |= {"limits": list(joint.limits_rad)}
    if joint.endless:
        table |= {"endless": True}
    if joint.counts_per_turn is not None:
        table |= {"counts_per_turn": joint.counts_per_turn}
    for effect in EFFECTS.values():
        table |= effect.written(joint.effects)
    return table
