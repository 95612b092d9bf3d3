"""A robot's drawing (URDF) as an arm: joint axes as Denavit–Hartenberg or Hayati joints, the tip as a probe.

Each axis is a line in the base frame at zero angles. The link from one axis to the next is their common normal (Denavit
and Hartenberg 1955); where they are parallel, or nearly, it is the Hayati form, which has no offset along the axis. Of
the two directions of a common normal the one nearer to zero offset is taken. The map is the same, not an approximation.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ulna.errors import UlnaInputError, nearest
from ulna.files.toml import read_bytes
from ulna.model import Arm, Joint, Probe

F64 = NDArray[np.float64]

#: axes closer to parallel than this (sine of their angle) become Hayati joints
PARALLEL = 0.05


@dataclass(frozen=True)
class Step:
    """One joint of a chain: a fixed transform, then, unless fixed, a turn about an axis."""

    name: str
    t_parent_joint: F64
    """(4, 4), mm."""
    axis: F64 | None
    """(3,) unit vector in the joint's frame; None for a fixed joint."""
    limits_rad: tuple[float, float] | None = None


def read_chain(path: Path, tip_link: str | None = None) -> tuple[str, list[Step]]:
    """Name and joints from the root to a link; without one, to `ball_link`, or to the end of the longest chain.

    Raises UlnaInputError for a file that is no URDF, an unknown link, or a joint on the way that is not rotary.
    """
    what = "a robot description (URDF)"
    try:
        robot = ElementTree.fromstring(read_bytes(path, what))
    except ElementTree.ParseError as error:
        raise UlnaInputError(f"{path}: not valid XML: {error}; expected {what}.") from None
    if robot.tag != "robot":
        raise UlnaInputError(f"{path}: the outermost element is <{robot.tag}>; expected <robot>: {what}.")
    above: dict[str, tuple[str, ElementTree.Element]] = {}
    for joint in robot.findall("joint"):
        above[_link(joint, "child", path)] = (_link(joint, "parent", path), joint)
    chains = {child: _way(child, above) for child in above}
    if not chains:
        raise UlnaInputError(f"{path}: there are no joints; expected {what} with at least two rotary joints.")
    if tip_link is None:
        turning = {child: sum(joint.get("type") in _TURNING for joint in way) for child, way in chains.items()}
        longest = max(turning, key=lambda child: (turning[child], child == "ball_link", len(chains[child])))
        tip_link = "ball_link" if turning.get("ball_link") == turning[longest] else longest
    if tip_link not in chains:
        raise UlnaInputError(f"{path}: there is no link '{tip_link}' below a joint.{nearest(tip_link, chains)}")
    return robot.get("name") or path.stem, [_step(joint, path) for joint in chains[tip_link]]


_TURNING = ("revolute", "continuous")


def _link(joint: ElementTree.Element, role: str, path: Path) -> str:
    element = joint.find(role)
    name = None if element is None else element.get("link")
    if name is None:
        raise UlnaInputError(
            f"{path}: joint '{joint.get('name')}' names no {role} link; expected <{role} link=\"…\"/>."
        )
    return name


def _way(link: str, above: dict[str, tuple[str, ElementTree.Element]]) -> list[ElementTree.Element]:
    way: list[ElementTree.Element] = []
    while link in above and len(way) <= len(above):
        link, joint = above[link]
        way.insert(0, joint)
    return way


def _step(joint: ElementTree.Element, path: Path) -> Step:
    name, kind = joint.get("name") or "?", joint.get("type")
    origin = joint.find("origin")
    xyz_m = _vector(origin, "xyz", "0 0 0", name, path)
    roll, pitch, yaw = _vector(origin, "rpy", "0 0 0", name, path)
    t = np.eye(4)
    t[:3, :3] = turn("z", yaw) @ turn("y", pitch) @ turn("x", roll)
    t[:3, 3] = 1000.0 * xyz_m
    if kind == "fixed":
        return Step(name, t, None)
    if kind not in _TURNING:
        raise UlnaInputError(
            f"{path}: joint '{name}' is of type '{kind}'; expected rotary or fixed joints up to the tip."
        )
    axis = _vector(joint.find("axis"), "xyz", "1 0 0", name, path)
    limit = joint.find("limit")
    limits = None
    if kind == "revolute" and limit is not None and limit.get("lower") is not None and limit.get("upper") is not None:
        limits = (float(limit.get("lower", "0")), float(limit.get("upper", "0")))
    return Step(name, t, axis / np.linalg.norm(axis), limits)


def _vector(element: ElementTree.Element | None, key: str, usual: str, joint: str, path: Path) -> F64:
    text = usual if element is None else element.get(key, usual)
    try:
        values = np.array([float(part) for part in text.split()])
    except ValueError:
        values = np.empty(0)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise UlnaInputError(f"{path}: joint '{joint}', {key}: got '{text}', expected three numbers. Correct it.")
    return values


def turn(axis: str, angle_rad: float) -> F64:
    """(3, 3) rotation about x, y or z."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def chain_tip(steps: list[Step], q_rad: F64) -> F64:
    """(N, n) → (N, 3) mm by the chain as drawn, axis by axis (Rodrigues): what an arm made of it must equal."""
    tips = np.empty((len(q_rad), 3))
    for k, angles in enumerate(q_rad):
        t, remaining = np.eye(4), iter(angles)
        for step in steps:
            t = t @ step.t_parent_joint
            if step.axis is not None:
                angle = next(remaining)
                x, y, z = step.axis
                cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
                t[:3, :3] = t[:3, :3] @ (np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross)
        tips[k] = t[:3, 3]
    return tips


def arm_from_chain(name: str, steps: list[Step], path: Path) -> Arm:
    """The chain as an arm with one probe `ball`. Raises UlnaInputError for fewer than two rotary joints.

    The arm's base frame is the drawing's where joint 1 turns about its z axis, as nearly all do; otherwise it stands
    on axis 1.
    """
    axes: list[tuple[Step, F64, F64]] = []  # joint, a point on its axis, its direction; base frame, zero angles
    t = np.eye(4)
    for step in steps:
        t = t @ step.t_parent_joint
        if step.axis is not None:
            axes.append((step, t[:3, 3].copy(), t[:3, :3] @ step.axis))
    if len(axes) < 2:
        raise UlnaInputError(f"{path}: there are {len(axes)} rotary joints up to the tip; expected at least two.")
    frame = _on_first_axis(axes[0][1], axes[0][2])
    joints: list[Joint] = []
    for (step, _, _), (_, point, direction) in pairwise(axes):
        r, o = frame[:3, :3], frame[:3, 3]
        link = _link_between(r.T @ (point - o), r.T @ direction, step)
        joints.append(link)
        frame = frame @ _link_at_zero(link)
    last = axes[-1][0]
    joints.append(Joint(name=last.name, limits_rad=last.limits_rad))
    x, y, z = (frame[:3, :3].T @ (t[:3, 3] - frame[:3, 3])).tolist()
    return Arm(name, tuple(joints), {"ball": Probe(x, y, z)})


def _on_first_axis(point: F64, direction: F64) -> F64:
    frame = np.eye(4)
    if math.hypot(point[0], point[1]) < 1e-9 and np.allclose(direction, (0.0, 0.0, 1.0), atol=1e-12):
        return frame
    x = np.cross((0.0, 1.0, 0.0) if abs(direction[1]) < 0.9 else (0.0, 0.0, 1.0), direction)
    x /= np.linalg.norm(x)
    frame[:3, :3] = np.column_stack([x, np.cross(direction, x), direction])
    frame[:3, 3] = point
    return frame


def _link_between(p: F64, w: F64, step: Step) -> Joint:
    """From the axis z of this frame to the next: the line through p along w, in this frame."""
    normal = np.array([-w[1], w[0]])  # z × w
    sine = float(np.hypot(*normal))
    if sine < PARALLEL:
        p = p - w * (p[2] / w[2])  # where the next axis meets the plane z = 0
        a_mm = float(np.hypot(p[0], p[1]))
        turn_rad = math.atan2(p[1], p[0]) if a_mm > 1e-9 else 0.0
        if abs(turn_rad) > math.pi / 2:
            turn_rad, a_mm = turn_rad - math.copysign(math.pi, turn_rad), -a_mm
        v = turn("z", turn_rad).T @ w
        alpha, beta = math.atan2(-v[1], v[2]), math.asin(max(-1.0, min(1.0, v[0])))
        return _joint(step, -turn_rad, alpha, a_mm, beta_rad=beta)
    n = normal / sine
    if n[0] < 0 or (n[0] < 1e-12 and n[1] < 0):
        n, sine = -n, -sine
    a_mm = float(n @ p[:2])
    along = float((n[0] * p[1] - n[1] * p[0]) / (n[0] * w[1] - n[1] * w[0]))  # of w, back to the common normal
    d_mm = float(p[2] - along * w[2])
    turn_rad = math.atan2(n[1], n[0])
    return _joint(step, -turn_rad, math.atan2(sine, w[2]), a_mm, d_mm=d_mm)


def _joint(
    step: Step, theta0_rad: float, alpha_rad: float, a_mm: float, d_mm: float = 0.0, beta_rad: float | None = None
) -> Joint:
    def plain(value: float) -> float:  # rounding of the way here would make an arm file hard to read
        return 0.0 if abs(value) < 1e-13 else value

    return Joint(
        theta0_rad=plain(theta0_rad),
        alpha_rad=plain(alpha_rad),
        a_mm=plain(a_mm),
        d_mm=plain(d_mm),
        beta_rad=plain(beta_rad or 0.0),
        model="dh" if beta_rad is None else "hayati",
        name=step.name,
        limits_rad=step.limits_rad,
    )


def _link_at_zero(joint: Joint) -> F64:
    t = np.eye(4)
    rz = turn("z", -joint.theta0_rad)
    t[:3, :3] = rz @ turn("x", joint.alpha_rad) @ turn("y", joint.beta_rad)
    t[:3, 3] = rz @ np.array([joint.a_mm, 0.0, joint.d_mm])
    return t
