"""An arm as a URDF of its own: one link and one joint for each encoder, a fixed joint to the tip of each probe."""

from __future__ import annotations

import re
from collections.abc import Iterable
from xml.sax.saxutils import quoteattr

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.base import t_base_first
from ulna.arm.frames.links import link_at_zero
from ulna.arm.frames.rigid import inverse, pose, to_rpy, turn
from ulna.arm.given import ArmLike, as_arm
from ulna.arm.joint import Joint
from ulna.ground.arrays import F64

BASE = "base_link"

HEAD = """\
<?xml version="1.0" encoding="utf-8"?>
<!-- Written by Ulna. Lengths in m, angles in rad; joint angles are what the encoders read. -->
"""
NO_MOTOR = (
    "  <!-- effort and velocity are not known to Ulna: 0 forbids a controller to move. Set them before one does. -->\n"
)


def urdf_text(arm: ArmLike) -> str:
    """The arm as a URDF. Fed with the same encoder angles, the link named as a probe stands at `arm.tip`.

    A joint's origin holds alpha and a of the link before it (beta as well), then its own theta0 and d; its axis is z,
    or -z where the encoder counts the other way. The root is the arm's base frame. Names become such as ROS takes.
    """
    arm = as_arm(arm)
    links = _names([BASE, *(f"link_{k}" for k in range(1, arm.n + 1)), *arm.probes])
    joints = _names(joint.name or f"joint_{k}" for k, joint in enumerate(arm.joints, start=1))
    fixed = _names([*joints, *(f"{name}_joint" for name in links[arm.n + 1 :])])[arm.n :]
    parts = [HEAD, f"<robot name={quoteattr(_name(arm.name))}>\n"]
    if any(joint.limits_rad for joint in arm.joints):
        parts.append(NO_MOTOR)
    parts += [f"  <link name={quoteattr(name)}/>\n" for name in links]
    *origins, t_end = joint_origins(arm)
    for k, (joint, t) in enumerate(zip(arm.joints, origins, strict=True)):
        parts.append(_joint(joints[k], links[k], links[k + 1], t, joint))
    for name, link, probe in zip(fixed, links[arm.n + 1 :], arm.probes.values(), strict=True):
        parts.append(_joint(name, links[arm.n], link, t_end @ pose(np.eye(3), probe.tip_mm), None))
    return "".join([*parts, "</robot>\n"])


def joint_origins(arm: Arm) -> list[F64]:
    """(4, 4) each, mm: every joint's frame in that of the joint before it, at encoder angle 0; then that of the tips.
    That of the first is in the base frame, in which its axis may lean and stand aside.

    `Tx(a) · Rx(alpha) · Ry(beta)` of the link before, then `Rz(-theta0) · Tz(d)` of the joint's own link: a turn about
    the joint's axis may as well come before the encoder's, and so may both before a shift along it.
    """
    origins = []
    before = t_base_first(arm)
    for joint in arm.joints:
        own = pose(turn("z", -joint.theta0_rad), np.array([0.0, 0.0, joint.d_mm]))
        origins.append(before @ own)
        before = inverse(own) @ link_at_zero(joint)
    return [*origins, before]


def _joint(name: str, parent: str, child: str, t: F64, joint: Joint | None) -> str:
    kind = "fixed" if joint is None else _kind(joint)
    lines = [
        f"  <joint name={quoteattr(name)} type={quoteattr(kind)}>",
        f"    <parent link={quoteattr(parent)}/>",
        f"    <child link={quoteattr(child)}/>",
        f'    <origin xyz="{numbers(t[:3, 3] / 1000.0)}" rpy="{numbers(to_rpy(t[:3, :3]))}"/>',
    ]
    if joint is not None:
        lines.append(f'    <axis xyz="0 0 {joint.sign}"/>')
    if joint is not None and joint.limits_rad:
        low, high = (number(value / 1000.0 if joint.slides else value) for value in joint.limits_rad)
        lines.append(f'    <limit lower="{low}" upper="{high}" effort="0" velocity="0"/>')
    return "\n".join([*lines, "  </joint>\n"])


def _kind(joint: Joint) -> str:
    return "prismatic" if joint.slides else "revolute" if joint.limits_rad else "continuous"


#: m or rad: what rounding leaves where a zero is meant
_NOTHING = 1e-16


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return "0" if abs(value) < _NOTHING else repr(float(value)).removesuffix(".0")


def numbers(values: F64) -> str:
    """Several, with spaces between."""
    return " ".join(number(value) for value in values.tolist())


def _name(name: str) -> str:
    """As ROS takes it: letters, digits and a few signs."""
    return re.sub(r"[^\w./-]", "_", name, flags=re.ASCII) or "_"


def _names(names: Iterable[str]) -> list[str]:
    """The same for several, each of them different."""
    taken: list[str] = []
    for name in map(_name, names):
        again = (f"{name}_{k}" for k in range(2, len(taken) + 3))
        taken.append(name if name not in taken else next(each for each in again if each not in taken))
    return taken
