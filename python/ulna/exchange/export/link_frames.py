"""Where the links' frames of a description stand on a calibrated arm.

Each link is a body with two axes in it, its own joint's and the next one's, and its frame stays where it was with
respect to them. With G the frame on the joint's axis whose x is along the common normal to the next axis (towards it,
where they are parallel), as drawn and as calibrated: what was `G_drawn · K` becomes `G_calibrated · K`. So a zero
offset appears as a turn of the joint's own origin, a link length as a shift of the next. Both G come from the axes as
lines: it does not matter by which of several equal sets of parameters the arm is described. Two axes that are nearly
one line give no direction; there x is that of the frame before.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.base import t_base_first
from ulna.arm.frames.links import link_at_zero, link_between
from ulna.arm.frames.rigid import apart, inverse, pose, smallest_turn, turn
from ulna.arm.joint import Joint
from ulna.exchange.urdf.arm import frames_at_zero, seen_from
from ulna.exchange.urdf.chain import Chain
from ulna.ground.arrays import F64

#: parallel axes nearer to each other than this have no direction from one to the other that a calibration would keep
ONE_LINE_MM = 20.0


def calibrated_frames(
    chain: Chain, drawn: Arm, arm: Arm, probe: str, t_root_base: F64
) -> tuple[list[F64], list[int], F64]:
    """In the root's frame, mm: the frames that the rotary joints get, their signs, and where the tip is."""
    before, _ = frames_at_zero(chain)
    # On the same axes, each a frame that only the axes decide, and one that the arm's own numbers lead to.
    t_drawn = own_drawn = t_root_base @ t_base_first(drawn)
    t_arm = own_arm = t_root_base @ t_base_first(arm)
    frames: list[F64] = []
    signs = [arm.joints[0].sign]
    for k in range(arm.n - 1):
        like = _turned(drawn.joints[k], inverse(t_drawn) @ own_drawn)
        own_drawn, own_arm = own_drawn @ link_at_zero(drawn.joints[k]), own_arm @ link_at_zero(arm.joints[k])
        link, sense = _nearest(t_arm, own_arm, like)
        signs.append(arm.joints[k + 1].sign * sense)
        one_line = like.model == "hayati" and abs(like.a_mm) < ONE_LINE_MM
        g_arm, next_arm = _carried(link) if one_line else _along(link)
        g_drawn, next_drawn = _carried(like) if one_line else _along(like)
        frames.append(t_arm @ g_arm @ inverse(t_drawn @ g_drawn) @ before[k])
        t_arm, t_drawn = t_arm @ next_arm, t_drawn @ next_drawn
    frames.append(t_arm @ inverse(t_drawn) @ before[-1])
    t_root_tip = own_arm @ link_at_zero(arm.joints[-1]) @ pose(np.eye(3), arm.probes[probe].tip_mm)
    return frames, signs, t_root_tip


def _turned(link: Joint, turned: F64) -> Joint:
    """A link as it is from another frame on the same axis, less that frame's turn."""
    return replace(link, theta0_rad=link.theta0_rad - math.atan2(turned[1, 0], turned[0, 0]))


def _along(link: Joint) -> tuple[F64, F64]:
    """From a frame on an axis to G, `Rz(-theta0) · Tz(d)`, and to the next axis."""
    return pose(turn("z", -link.theta0_rad), np.array([0.0, 0.0, link.d_mm])), link_at_zero(link)


def _carried(link: Joint) -> tuple[F64, F64]:
    """The same, with x carried from axis to axis without a turn about them."""
    t = link_at_zero(link)
    w = t[:3, 2]
    r = smallest_turn(w) if w[2] > 0 else smallest_turn(-w) @ turn("x", math.pi)
    return np.eye(4), pose(r, t[:3, 3])


def _nearest(t: F64, t_next: F64, like: Joint) -> tuple[Joint, int]:
    """The link from the axis of `t` to that of `t_next`, and whether that is seen along its z (1) or against it (-1).

    Of the four descriptions of the same two lines the one nearest to the drawn link, in theta0 and alpha. An axis is
    seen against its z only where that saves more than a quarter turn: encoders rarely count against the drawing.
    """
    best: tuple[float, Joint, int] | None = None
    for sense in (1, -1):
        p_mm, w = seen_from(t, t_next[:3, 3], sense * t_next[:3, 2])
        for half in (0.0, math.pi):
            link = link_between(p_mm, w, like=replace(like, theta0_rad=like.theta0_rad + half))
            off = apart(link.theta0_rad, like.theta0_rad) + apart(link.alpha_rad, like.alpha_rad)
            off += math.pi / 2 if sense < 0 else 0.0
            if best is None or off < best[0] - 1e-9:
                best = (off, link, sense)
    assert best is not None
    return best[1], best[2]
