"""Arms of every kind that the model has, for tests of how they are drawn."""

from __future__ import annotations

import dataclasses

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import Effects
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe


def random_arm(seed: int, joints: int, full: bool = False) -> Arm:
    """Twists of any angle, Hayati joints among DH joints, encoders that count either way, two probes."""
    rng = np.random.default_rng(seed)
    made = []
    for k in range(joints):
        theta0, alpha = rng.uniform(-3.0, 3.0, 2)
        a, d = rng.uniform(-300.0, 300.0, 2)
        sign = int(rng.choice([1, -1]))
        if k % 3 == 1:
            made.append(Joint(theta0, rng.uniform(-0.05, 0.05), a, 0.0, rng.uniform(-0.05, 0.05), sign, "hayati"))
        else:
            made.append(Joint(theta0, alpha, a, d, 0.0, sign))
    if not full:
        made[-1] = dataclasses.replace(Joint(), sign=made[-1].sign)
    tips = {name: Probe(*rng.uniform(-150.0, 150.0, 3), 6.0) for name in ("bent", "other")}
    return Arm(f"random {seed}", tuple(made), tips, full_last_link=full)


def arms() -> list[Arm]:
    """One of each kind: two to seven joints, with and without a full last link, and one with coupled joints."""
    found = [random_arm(seed, joints, full) for seed, joints in enumerate((2, 3, 6, 7)) for full in (False, True)]
    return [*found, coupled(random_arm(9, 6))]


def coupled(arm: Arm) -> Arm:
    """Joint 3 turns with the second encoder too, as the elbow of a parallelogram does, joint 6 with two others."""
    joints = list(arm.joints)
    joints[2] = dataclasses.replace(joints[2], effects=Effects(coupled_to=(2,), coupling=(-1.0,)))
    joints[5] = dataclasses.replace(joints[5], effects=Effects(coupled_to=(4, 5), coupling=(0.5, -0.02)))
    return dataclasses.replace(arm, joints=tuple(joints))
