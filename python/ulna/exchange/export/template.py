"""A calibrated arm put into the URDF it was drawn in: other origins of the joints on the way, and nothing else touched.

The file is edited where the numbers stand, byte for byte, so comments, meshes, inertias and layout stay.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.rigid import from_rpy, inverse, pose, to_quaternion, to_rpy
from ulna.arm.given import ArmLike, as_arm
from ulna.exchange.export.link_frames import calibrated_frames
from ulna.exchange.export.urdf import number, numbers
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import Chain, Step, chain_of
from ulna.exchange.urdf.document import Document, read_document, start_tag
from ulna.exchange.urdf.numbers import vector
from ulna.exchange.urdf.units import in_units
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: changes below this, m or rad, are rounding: what stands in the file stays
UNCHANGED = 1e-13

#: changes above these are told: rather another robot, or another base
FAR_MM, FAR_RAD = 50.0, 0.2


@dataclass(frozen=True)
class Change:
    """What became of one joint."""

    joint: str
    shift_mm: float
    turn_rad: float
    reversed_axis: bool = False
    """The encoder counts against the axis as drawn, so the axis was turned round."""


@dataclass(frozen=True)
class Filled:
    """The template with the arm's numbers."""

    content: bytes
    base_link: str
    tip_link: str
    changes: list[Change]
    """Of all joints whose numbers are others now."""


def export_template(
    path: str | Path, arm: ArmLike, probe: str, tip_link: str | None = None, base_link: str | None = None
) -> Filled:
    """`fill_template` of a file. Raises UlnaInputError."""
    return fill_template(read_document(Path(path)), as_arm(arm), probe, tip_link, base_link)


def summary(filled: Filled, probe: str) -> str:
    """What was changed, for the user."""
    if not filled.changes:
        return f"no origin changed, link '{filled.tip_link}' is where probe '{probe}' ends: the arm is as drawn."
    shift, angle = (max(filled.changes, key=lambda c: getattr(c, key)) for key in ("shift_mm", "turn_rad"))
    count = f"{len(filled.changes)} origin{'s' * (len(filled.changes) > 1)}"
    return (
        f"{count} changed, at most by {shift.shift_mm:.3g} mm (joint '{shift.joint}') and "
        f"{angle.turn_rad:.3g} rad (joint '{angle.joint}'); link '{filled.tip_link}' ends in probe '{probe}'."
    )


def remarks(filled: Filled) -> list[str]:
    """What should be looked at."""
    found = [
        f"the axis of joint '{change.joint}' was turned round, because its encoder counts against the description "
        "(sign). Its limits are as they were: check them."
        for change in filled.changes
        if change.reversed_axis
    ]
    far = [c.joint for c in filled.changes if c.shift_mm > FAR_MM or c.turn_rad > FAR_RAD]
    if far:
        found.append(
            f"a calibration rarely changes an origin by more than {FAR_MM:g} mm or {FAR_RAD:g} rad, as here those of "
            f"{', '.join(far)}. Is this the arm's own URDF, does its base stand at link '{filled.base_link}' as "
            "there, is the tip that of the probe? If so, the readings may say little of them: ulna identify tells."
        )
    return found


def fill_template(
    document: Document, arm: Arm, probe: str, tip_link: str | None = None, base_link: str | None = None
) -> Filled:
    """The URDF with the origins of a calibrated arm; `tip_link` ends in the probe's tip. Links as in `read_chain`.

    Fed with the same encoder angles, the tip link stands at `t_root_base · arm.tip`, with `t_root_base` of
    `arm_from_chain`. Raises UlnaInputError where the arm does not fit.
    """
    # what is put into the file is in m
    chain = in_units(chain_of(document, tip_link, base_link), angle_unit="rad")
    drawn, t_root_base = arm_from_chain(chain)
    drawn.check_turns(chain.path, "descriptions that are filled in")
    arm.check_turns(chain.path, "descriptions that are filled in")
    if drawn.n != arm.n:
        raise UlnaInputError(
            f"{chain.path}: there are {drawn.n} rotary joints up to link '{chain.tip_link}', arm '{arm.name}' has "
            f"{arm.n}; expected as many. Name the arm's own URDF, or another link with --tip-link."
        )
    if chain.steps[-1].axis is not None:
        raise UlnaInputError(
            f"{chain.path}: link '{chain.tip_link}' turns with joint '{chain.steps[-1].name}', so its origin cannot be "
            "moved to the probe's tip; expected a link behind a fixed joint. Add one for the tip, or name one with "
            "--tip-link."
        )
    frames, signs, t_root_tip = calibrated_frames(chain, drawn, arm, probe, t_root_base)
    edits: list[tuple[int, int, bytes]] = []
    changes: list[Change] = []
    t = np.eye(4)
    turning = 0
    for step in chain.steps:
        new = step.t_parent_joint
        reverse = False
        if step.axis is not None:
            new = inverse(t) @ frames[turning]
            reverse = signs[turning] != drawn.joints[turning].sign
            turning += 1
        elif step is chain.steps[-1]:
            new = pose(new[:3, :3], (inverse(t) @ t_root_tip)[:3, 3])
        origin_edits = _edits(document, step, new, chain)
        if reverse:
            origin_edits += _reversed(document, step)
        if origin_edits:
            edits += origin_edits
            changes.append(_change(step, new, reverse))
        t = t @ new
    return Filled(_spliced(document.content, edits), chain.base_link, chain.tip_link, changes)


def _change(step: Step, new: F64, reverse: bool) -> Change:
    old = step.t_parent_joint
    half_sine = float(np.linalg.norm(old[:3, :3] - new[:3, :3])) / math.sqrt(8.0)
    shift_mm = float(np.linalg.norm(new[:3, 3] - old[:3, 3]))
    return Change(step.name, shift_mm, 2.0 * math.asin(min(1.0, half_sine)), reverse)


def _edits(document: Document, step: Step, new: F64, chain: Chain) -> list[tuple[int, int, bytes]]:
    """What to put where, so that the joint's origin is `new`; nothing where it is that already."""
    assert step.element is not None
    origin = step.element.find("origin")
    old_xyz_m = vector(origin, "xyz", "0 0 0", f"joint '{step.name}'", chain.path)
    old_rpy = vector(origin, "rpy", "0 0 0", f"joint '{step.name}'", chain.path)
    values: dict[str, str] = {}
    by_quaternion = origin is not None and origin.get("quat_xyzw") is not None
    if by_quaternion and np.abs(step.t_parent_joint[:3, :3] - new[:3, :3]).max() >= UNCHANGED:
        values["quat_xyzw"] = numbers(to_quaternion(new[:3, :3]))
    for key, old, is_new in (
        ("xyz", old_xyz_m, new[:3, 3] / 1000.0),
        ("rpy", old_rpy, to_rpy(new[:3, :3], near=old_rpy)),
    ):
        if key == "rpy" and (by_quaternion or np.abs(from_rpy(*old_rpy) - new[:3, :3]).max() < UNCHANGED):
            continue
        changed = np.abs(is_new - old) >= UNCHANGED
        if changed.any():
            tokens = ["0", "0", "0"] if origin is None else origin.get(key, "0 0 0").split()
            values[key] = " ".join(
                number(v) if c else token for v, c, token in zip(is_new, changed, tokens, strict=True)
            )
    if not values:
        return []
    if origin is None:
        _, end = start_tag(document, step.element)
        return [(end, end, _origin(values))]
    return _attributes(document, origin, values)


def _origin(values: dict[str, str]) -> bytes:
    return ("<origin" + "".join(f' {key}="{value}"' for key, value in values.items()) + "/>").encode()


def _attributes(document: Document, element: Element, values: dict[str, str]) -> list[tuple[int, int, bytes]]:
    """Other values for attributes of an element; those that it does not have are added."""
    begin, end = start_tag(document, element)
    there = {
        attribute[1]: attribute.span(2)
        for attribute in re.finditer(rb"""([^\s=<>"'/]+)\s*=\s*("[^"]*"|'[^']*')""", document.content[begin:end])
    }
    edits = []
    for key, value in values.items():
        if key.encode() in there:
            first, last = there[key.encode()]
            edits.append((begin + first + 1, begin + last - 1, value.encode()))
        else:
            at = begin + 1 + len(element.tag)
            edits.append((at, at, f' {key}="{value}"'.encode()))
    return edits


def _reversed(document: Document, step: Step) -> list[tuple[int, int, bytes]]:
    """The joint's axis the other way."""
    assert step.element is not None
    assert step.axis is not None
    axis = step.element.find("axis")
    if axis is None:
        _, end = start_tag(document, step.element)
        return [(end, end, b'<axis xyz="-1 0 0"/>')]
    values = [float(part) for part in axis.get("xyz", "1 0 0").split()]
    return _attributes(document, axis, {"xyz": numbers(-np.array(values))})


def _spliced(content: bytes, edits: list[tuple[int, int, bytes]]) -> bytes:
    parts, at = [], 0
    for begin, end, text in sorted(edits, key=lambda edit: edit[:2]):
        parts += [content[at:begin], text]
        at = end
    return b"".join([*parts, content[at:]])
