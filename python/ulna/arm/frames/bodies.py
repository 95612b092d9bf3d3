"""The chain as bodies that turn: constant transforms between joints, and a turn about z at each joint.

`T_i = Rz(sign_i q_i - theta0_i) · Tz(d_i) · Tx(a_i) · Rx(alpha_i) · Ry(beta_i)` is `Rz(sign_i q_i)` and a transform
that no encoder changes. So a reader of these transforms needs to know a turn about z and nothing else of the model; how
far each joint turns is a constant matrix times the encoders' angles. A joint that slides has a shift along z in
place of the turn.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ulna.arm.data import ArmData
from ulna.arm.effects.effect import Effect
from ulna.arm.frames.base import t_base_first
from ulna.arm.frames.links import link_at_zero
from ulna.arm.frames.rigid import pose, turn
from ulna.ground.arrays import F64


def constant_transforms(arm: ArmData) -> list[F64]:
    """n + 1 times (4, 4), mm: what stands before joint 1, 2, … n, and between the last joint and the probes' tips.

    The first is the identity where the base frame is on axis 1; so is the last, unless the arm has a full last link.
    """
    first, links = t_base_first(arm), [link_at_zero(joint) for joint in arm.joints]
    return [first, *links] if arm.full_last_link else [first, *links[:-1], np.eye(4)]


def turns(arm: ArmData) -> F64:
    """(n, n): how far each joint turns for a unit of each encoder: signs, and where joints are coupled their ratios."""
    shares = np.eye(arm.n)
    for effect in arm.effects:
        for joint, encoder, ratio in effect.ratios([each.effects for each in arm.joints]):
            shares[joint, encoder] += ratio
    found: F64 = arm.signs[:, None] * shares
    return found


def pictured(effect: Effect, arm: ArmData) -> bool:
    """Whether a picture has all that an effect does: nothing but such ratios, or where the arm stands."""
    return effect.of_first or bool(effect.ratios([each.effects for each in arm.joints]))


def bodies(arm: ArmData, q_rad: ArrayLike) -> list[F64]:
    """n + 1 times (4, 4), mm, in the base frame: the base itself, and each body that turns with joint 1, 2, … n.

    q_rad: (n,) encoder angles. A body's frame is on its joint's axis, and coincides at q = 0 with the frame before it.
    """
    t = np.eye(4)
    found = [t]
    turned_rad = turns(arm) @ np.asarray(q_rad, dtype=np.float64)
    for before, moved, joint in zip(constant_transforms(arm), turned_rad.tolist(), arm.joints, strict=False):
        shift_mm = np.array([0.0, 0.0, moved if joint.slides else 0.0])
        t = t @ before @ pose(turn("z", 0.0 if joint.slides else moved), shift_mm)
        found.append(t)
    return found
