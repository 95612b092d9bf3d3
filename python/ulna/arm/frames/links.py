"""The link from one axis to the next, and back: what theta0, alpha, a, d or beta say of a line.

The link from an axis to the next is their common normal (Denavit and Hartenberg 1955); where they are parallel, or
nearly, it is the Hayati form, which has no offset along the axis (Hayati 1983). The map is the same in both.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ulna.arm.frames.rigid import inverse, pose, turn
from ulna.arm.joint import Joint, JointModel
from ulna.arm.probe import Probe
from ulna.ground.arrays import F64

#: axes closer to parallel than this (sine of their angle) become Hayati joints
PARALLEL = 0.05

#: axes closer to parallel than this have no common normal, closer to perpendicular no crossing of a plane
_NONE = 1e-6

#: an axis nearer to perpendicular than this (cosine of its angle) meets the plane across the one before so far off that
#: an offset is the better number
_CROSSING = 0.5

#: axes nearer to each other than this, mm, where they meet the plane have no direction from one to the other
_NO_LINK_MM = 1e-11

#: what rounding leaves where a zero is meant; it would make an arm file hard to read
_NO_ANGLE_RAD, _NO_LENGTH_MM = 1e-14, 1e-12


def link_at_zero(joint: Joint) -> F64:
    """(4, 4) `T_i` at encoder angle 0: `Rz(-theta0) · Tz(d) · Tx(a) · Rx(alpha) · Ry(beta)`; beta or d is 0."""
    rz = turn("z", -joint.theta0_rad)
    r = rz @ turn("x", joint.alpha_rad) @ turn("y", joint.beta_rad)
    return pose(r, rz @ np.array([joint.a_mm, 0.0, joint.d_mm]))


def link_between(p_mm: F64, w: F64, like: Joint | None = None) -> Joint:
    """The link from the axis z of a frame to the line through p along the unit vector w, both in that frame.

    Of the two directions of a common normal the one nearer to zero offset is taken. With `like` it is the one nearer to
    that link's, and the form (DH or Hayati) is that link's as well, as far as the axes have one.
    """
    sine = float(np.hypot(w[0], w[1]))
    parallel = sine < PARALLEL if like is None else like.model == "hayati"
    parallel = (parallel and abs(w[2]) > _NONE) or sine < _NONE
    near_rad = 0.0 if like is None else -like.theta0_rad
    if parallel:
        p_mm = p_mm - w * (p_mm[2] / w[2])  # where the next axis meets the plane z = 0
        a_mm = float(np.hypot(p_mm[0], p_mm[1]))
        if a_mm < _NO_LINK_MM:
            a_mm, turn_rad = 0.0, near_rad
        else:
            turn_rad = math.atan2(p_mm[1], p_mm[0])
        if _other_way(turn_rad, near_rad):
            turn_rad, a_mm = turn_rad - math.copysign(math.pi, turn_rad), -a_mm
        v = turn("z", -turn_rad) @ w
        alpha_rad, beta_rad = math.atan2(-v[1], v[2]), math.asin(max(-1.0, min(1.0, v[0])))
        return _joint(-turn_rad, alpha_rad, a_mm, 0.0, beta_rad, "hayati")
    n = np.array([-w[1], w[0]]) / sine  # z × w
    turn_rad = math.atan2(n[1], n[0])
    if _other_way(turn_rad, near_rad):
        n, sine, turn_rad = -n, -sine, turn_rad - math.copysign(math.pi, turn_rad)
    along = float((n[0] * p_mm[1] - n[1] * p_mm[0]) / (n[0] * w[1] - n[1] * w[0]))  # of w, back to the common normal
    return _joint(-turn_rad, math.atan2(sine, w[2]), float(n @ p_mm[:2]), float(p_mm[2] - along * w[2]), 0.0, "dh")


def sliding_link(p_mm: F64, w: F64) -> Joint:
    """The same of a joint that slides along the axis z: always of DH, for what slides has no Hayati form.

    It may be that the line goes through the axis itself, as where the axis was put there.
    """
    aside_mm, sine = float(np.hypot(p_mm[0], p_mm[1])), float(np.hypot(w[0], w[1]))
    if aside_mm < _NO_LINK_MM:
        theta0_rad = -math.atan2(w[0], -w[1]) if sine > _NO_ANGLE_RAD else 0.0
        return _joint(theta0_rad, math.atan2(sine, w[2]), 0.0, float(p_mm[2]), 0.0, "dh")
    if sine < _NONE:
        theta0_rad = -math.atan2(p_mm[1], p_mm[0])
        return _joint(theta0_rad, 0.0 if w[2] > 0 else math.pi, aside_mm, float(p_mm[2]), 0.0, "dh")
    return link_between(p_mm, w, like=Joint())


def _other_way(turn_rad: float, near_rad: float) -> bool:
    """Whether the opposite direction is nearer. Of two that are as near, up to rounding, the positive one stays."""
    off = math.remainder(turn_rad - near_rad, 2 * math.pi)
    return not -math.pi / 2 + 1e-12 <= off <= math.pi / 2 + 1e-12


def _joint(theta0_rad: float, alpha_rad: float, a_mm: float, d_mm: float, beta_rad: float, model: str) -> Joint:
    def angle(value: float) -> float:
        return 0.0 if abs(value) < _NO_ANGLE_RAD else value

    return Joint(
        angle(theta0_rad),
        angle(alpha_rad),
        without_rounding_mm(a_mm),
        without_rounding_mm(d_mm),
        angle(beta_rad),
        model="hayati" if model == "hayati" else "dh",
    )


def without_rounding_mm(value_mm: float) -> float:
    """0 for a length that is nothing but rounding."""
    return 0.0 if abs(value_mm) < _NO_LENGTH_MM else value_mm


def hayati_where_parallel(
    joints: Sequence[Joint], probes: Mapping[str, Probe]
) -> tuple[tuple[Joint, ...], dict[str, Probe], list[int]]:
    """The same arm with Hayati joints where an axis is (nearly) parallel to the next; and which (from 1) became so.

    An offset d of such a joint slides along the next axis: into the next joint's d, or from the last one into the tips.
    One that slides into a Hayati joint, which has none either, slides on; where that joint's next axis is too far from
    parallel to take it, the joint becomes a DH joint, and counts as changed as well.
    """
    out: list[Joint] = []
    changed: list[int] = []
    t_new_old = np.eye(4)  # a turn about the axis that both frames have as z, and a shift along it
    for k, joint in enumerate(joints[:-1], start=1):
        old = t_new_old @ link_at_zero(joint)
        theta0_rad = joint.theta0_rad - math.atan2(t_new_old[1, 0], t_new_old[0, 0])
        d_mm = without_rounding_mm(joint.d_mm + float(t_new_old[2, 3]))
        own = replace(joint, theta0_rad=theta0_rad, d_mm=d_mm)
        t_new_old = np.eye(4)
        parallel = not joint.slides and abs(math.sin(joint.alpha_rad)) < PARALLEL  # what slides has a d
        if joint.model == "hayati" or parallel:
            if d_mm:
                own = _without_offset(own, old)
                t_new_old = inverse(link_at_zero(own)) @ old
            else:  # its numbers stay as they are
                own = replace(own, model="hayati")
        if own.model != joint.model:
            changed.append(k)
        out.append(own)
    return (*out, joints[-1]), moved(probes, t_new_old), changed


def _without_offset(own: Joint, t_next: F64) -> Joint:
    """A joint to the axis z of (4, 4) `t_next` without an offset, or, where that is far from parallel, a DH joint."""
    form: JointModel = "hayati" if abs(t_next[2, 2]) > _CROSSING else "dh"
    link = link_between(t_next[:3, 3], t_next[:3, 2], like=replace(own, model=form))
    return replace(
        own, theta0_rad=link.theta0_rad, alpha_rad=link.alpha_rad, a_mm=link.a_mm, d_mm=link.d_mm,
        beta_rad=link.beta_rad, model=link.model,
    )  # fmt: skip


def moved(probes: Mapping[str, Probe], t: F64) -> dict[str, Probe]:
    """Tips given in a frame, in the frame in which that stands at (4, 4) `t`."""
    found = {}
    for name, probe in probes.items():
        x, y, z = (t[:3, :3] @ probe.tip_mm + t[:3, 3]).tolist()
        found[name] = replace(probe, x_mm=x, y_mm=y, z_mm=z)
    return found
