"""Rough masses for robots that nobody weighed: 4 kg falling to 1 kg from the base to the tip, in the middles of links.

The same that docs/real-readings.md adds (tools/docs_real_readings.py)."""

import math
from dataclasses import replace

import ulna
from benchmarks.coverage.real_sets import Fold


def weighed(fold: Fold) -> Fold:
    """With masses in the arm; its own where the drawing has them."""
    arm = fold.fitted.arm
    if any(joint.effects.mass_kg for joint in arm.joints):
        return fold
    joints = list(arm.joints)
    for number, joint in enumerate(joints[:-1]):
        sine, cosine = math.sin(joint.alpha_rad), math.cos(joint.alpha_rad)
        middle = (-joint.a_mm / 2.0, -joint.d_mm / 2.0 * sine, -joint.d_mm / 2.0 * cosine)
        joints[number] = _with_mass(joint, round(4.0 - 3.0 * number / (arm.n - 1), 1), middle)
    (probe,) = arm.probes.values()
    joints[-1] = _with_mass(joints[-1], 1.0, (probe.x_mm / 2.0, probe.y_mm / 2.0, probe.z_mm / 2.0))
    return replace(fold, fitted=fold.fitted.with_arm(replace(arm, joints=tuple(joints))))


def _with_mass(joint: ulna.Joint, mass_kg: float, centre_mm: tuple[float, float, float]) -> ulna.Joint:
    x, y, z = (round(value) + 0.0 for value in centre_mm)
    return replace(joint, effects=replace(joint.effects, mass_kg=mass_kg, centre_mm=(x, y, z)))
