"""Hayati joints written as Denavit–Hartenberg joints: what controllers take that know no `beta`.

Two axes that are not exactly parallel have a common normal, if a distant one (Denavit and Hartenberg 1955): the more
nearly parallel, the larger the offsets d to it and back, with opposite signs in this joint and the next.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import atan2

import numpy as np

from ulna.arm.frames.links import link_at_zero, link_between, moved
from ulna.arm.frames.rigid import inverse
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe

#: a common normal farther away than this, mm, is none: sixteen digits no longer say where the tip is to a micrometre
FARTHEST_MM = 1e6

#: offsets larger than this, mm, are remarked upon: no link is as long, and small changes of angles change them much
LARGE_MM = 5000.0


def pure_dh(
    joints: Sequence[Joint], probes: Mapping[str, Probe], full_last_link: bool = False
) -> tuple[tuple[Joint, ...], dict[str, Probe], list[int]]:
    """The same arm without `beta`, its tips the same in every pose to rounding; and which joints (from 1) keep it.

    What each frame is turned about the next axis and shifted along it goes into the next joint, in the end into the
    tips. A joint keeps its `beta` where its axis and the next have no common normal within `FARTHEST_MM`.
    """
    out: list[Joint] = []
    kept: list[int] = []
    t_new_old = np.eye(4)  # a turn about the axis that both frames have as z, and a shift along it
    linked = len(joints) if full_last_link else len(joints) - 1
    for k, joint in enumerate(joints[:linked], start=1):
        old = t_new_old @ link_at_zero(joint)
        theta0_rad = joint.theta0_rad - atan2(t_new_old[1, 0], t_new_old[0, 0])
        own = replace(joint, theta0_rad=theta0_rad, d_mm=joint.d_mm + float(t_new_old[2, 3]))
        if joint.beta_rad:
            link = link_between(old[:3, 3], old[:3, 2], like=replace(own, model="dh"))
            if link.model != "dh" or abs(link.d_mm) > FARTHEST_MM:
                kept.append(k)
                link = link_between(old[:3, 3], old[:3, 2], like=replace(own, model="hayati"))
            own = replace(
                own, theta0_rad=link.theta0_rad, alpha_rad=link.alpha_rad, a_mm=link.a_mm, d_mm=link.d_mm,
                beta_rad=link.beta_rad, model=link.model,
            )  # fmt: skip
        elif joint.model == "hayati":
            own = replace(own, model="dh")
        t_new_old = inverse(link_at_zero(own)) @ old if joint.beta_rad else np.eye(4)
        out.append(own)
    return (*out, *joints[linked:]), moved(probes, t_new_old), kept
