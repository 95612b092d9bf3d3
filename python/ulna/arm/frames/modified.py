"""The modified Denavit–Hartenberg form (Craig 1986, *Introduction to Robotics*), turned into Ulna's and back.

    modified      Rx(alpha_{i-1}) · Tx(a_{i-1}) · Rz(turn_i) · Tz(d_i)      i = 1 … n, then the tip
    upper-joint   Rz(turn_i) · Tz(d_i) · Tx(a_i) · Rx(alpha_i)              i = 1 … n-1, then Rz(sign_n q_n), the tip

The same product, with its factors counted to another joint: what stands before joint i+1 stands after joint i.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Literal

import numpy as np

from ulna.arm.frames.links import moved
from ulna.arm.frames.rigid import pose, turn
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.arrays import F64

Convention = Literal["dh", "modified-dh"]


def from_modified(
    rows: Sequence[Joint], probes: Mapping[str, Probe]
) -> tuple[tuple[Joint, ...], dict[str, Probe], F64]:
    """A table of n rows, alpha and a of row i before joint i, and tips in its last frame: the same in Ulna's form.

    Alpha and a of row i+1 go to joint i. The last row's theta0 and d go into the tips: turned by -theta0 about z,
    lifted by d. The first row's alpha and a only place the base: (4, 4) `t_table_base`, mm, says where the arm's base
    frame stands in the table's; the identity where both are 0. Rows are DH joints. No number is computed but the tips'.
    """
    joints = [
        replace(row, alpha_rad=after.alpha_rad, a_mm=after.a_mm) for row, after in pairwise(rows)
    ]  # fmt: skip
    first, last = rows[0], rows[-1]
    joints.append(replace(last, theta0_rad=0.0, alpha_rad=0.0, a_mm=0.0, d_mm=0.0))
    base = turn("x", first.alpha_rad)
    end = pose(turn("z", -last.theta0_rad), np.array([0.0, 0.0, last.d_mm]))
    return tuple(joints), moved(probes, end), pose(base, base @ np.array([first.a_mm, 0.0, 0.0]))


def to_modified(joints: Sequence[Joint]) -> list[Joint]:
    """The rows of a modified table, alpha and a before each joint. Tips stay in the last joint's frame.

    A Hayati joint with a beta has no place in such a table: ValueError. One without is a DH joint with d = 0.
    """
    if any(joint.beta_rad for joint in joints):
        raise ValueError("a modified table has no beta")
    before = (Joint(), *joints)
    return [
        replace(joint, alpha_rad=link.alpha_rad, a_mm=link.a_mm, model="dh")
        for link, joint in zip(before, joints, strict=False)
    ]
