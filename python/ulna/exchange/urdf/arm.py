"""A chain as an arm: its axes as Denavit–Hartenberg or Hayati joints, the tip as a probe, and where the base stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import NONE, Effects
from ulna.arm.frames.links import PARALLEL, link_at_zero, link_between, sliding_link, without_rounding_mm
from ulna.arm.frames.rigid import inverse, pose, smallest_turn
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.exchange.urdf.chain import Chain
from ulna.exchange.urdf.masses import Mass
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: a first axis nearer to upright than this is upright
_NO_ANGLE_RAD = 1e-14


def arm_from_chain(chain: Chain) -> tuple[Arm, F64]:
    """The chain as an arm with one probe `ball`, and (4, 4) `t_root_base`, mm: the arm's base frame in the root's.

    The drawn tip is `t_root_base · arm.tip(q)` in every pose, to rounding. The model wants its base frame on axis 1: it
    is the root's where that stands there, and where not, the root's moved the shortest way to the axis and turned by
    the smallest angle. An axis that points another way is geometry of the link before it. Axis 1 has no link before it:
    one that points down, as of robots that turn clockwise, has sign -1. Of a prismatic joint only the direction
    matters: it is taken to lie where the next joint is. Where the chain's links have masses, so have the joints, and
    gravity pulls down the root's z.
    Raises UlnaInputError for fewer than two joints that turn or slide.
    """
    frames, t_root_tip = frames_at_zero(chain)
    if len(frames) < 2:
        raise UlnaInputError(
            f"{chain.path}: there are {len(frames)} joints that turn or slide up to link '{chain.tip_link}'; expected "
            "at least two. Choose another link with --tip-link."
        )
    turning = chain.turning
    axes = [t[:3, :3] @ step.axis for t, step in zip(frames, turning, strict=True) if step.axis is not None]
    points = [t[:3, 3] for t in frames]
    for k in reversed(range(1, len(frames) - 1)):
        points[k] = points[k + 1] if turning[k].slides else points[k]
    t_root_base, sign = _base(points[0], axes[0])
    joints: list[Joint] = []
    t = t_root_base
    for k, step in enumerate(turning):
        link = Joint()
        if k < len(turning) - 1:
            line = seen_from(t, points[k + 1], axes[k + 1])
            link = sliding_link(*line) if step.slides else link_between(*line)
            t = t @ link_at_zero(link)
        own = _mass(step.mass, inverse(t) @ frames[k])
        link = replace(link, sign=sign if k == 0 else 1, name=step.name, limits_rad=step.limits_rad, effects=own)
        link = replace(link, endless=step.endless, type="prismatic" if step.slides else "rotary")
        joints.append(link)
    x, y, z = (without_rounding_mm(value) for value in (inverse(t) @ t_root_tip)[:3, 3].tolist())
    down = (-t_root_base[2, :3]).tolist() if any(joint.effects.mass_kg for joint in joints) else [0.0, 0.0, -1.0]
    gravity = (down[0] + 0.0, down[1] + 0.0, down[2])
    return Arm(chain.name, tuple(joints), {"ball": Probe(x, y, z)}, gravity=gravity), t_root_base


def _mass(mass: Mass, t_link_joint: F64) -> Effects:
    """In the frame after the link, given the joint's own frame in that."""
    if not mass.kg:
        return NONE
    x, y, z = (round(value, 6) + 0.0 for value in (t_link_joint @ [*mass.centre_mm, 1.0])[:3].tolist())
    return Effects(mass_kg=mass.kg, centre_mm=(x, y, z))


def frames_at_zero(chain: Chain) -> tuple[list[F64], F64]:
    """(4, 4) each, in the root's frame, all angles 0, mm: the frames of the rotary joints, and of the tip link."""
    frames: list[F64] = []
    t = np.eye(4)
    for step in chain.steps:
        t = t @ step.t_parent_joint
        if step.axis is not None:
            frames.append(t)
    return frames, t


def seen_from(t: F64, point_mm: F64, direction: F64) -> tuple[F64, F64]:
    """A line in the frame that stands at `t`."""
    return t[:3, :3].T @ (point_mm - t[:3, 3]), t[:3, :3].T @ direction


def _base(point_mm: F64, axis: F64) -> tuple[F64, int]:
    """Where the arm's base frame stands on axis 1, and the joint's sign."""
    down = axis[2] < 0 and float(np.hypot(axis[0], axis[1])) < PARALLEL
    z = -axis if down else axis
    t = pose(smallest_turn(z), point_mm - z * float(z @ point_mm))
    upright = bool(np.all(np.abs(z[:2]) < _NO_ANGLE_RAD))
    if upright:
        t[:3, :3] = np.eye(3)
    t[:3, 3] = [without_rounding_mm(value) for value in t[:3, 3].tolist()]
    return t, -1 if down else 1
