"""Nominal geometry of robots whose readings are public, as arms. Facts of the makers' data sheets, mm and rad."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ulna.arm.arm import Arm
from ulna.arm.frames.modified import from_modified
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe

_QUARTER = math.pi / 2


def panda() -> Arm:
    """Franka Emika Panda, seven axes, with a ball on the axis of the hand.

    The maker gives modified Denavit–Hartenberg parameters (Craig): a_{i-1} and alpha_{i-1} stand before joint i.
    """
    a_mm = (0.0, 0.0, 0.0, 82.5, -82.5, 0.0, 88.0)
    d_mm = (333.0, 0.0, 316.0, 0.0, 384.0, 0.0, 0.0)
    alpha_rad = (0.0, -_QUARTER, _QUARTER, _QUARTER, -_QUARTER, _QUARTER, _QUARTER)
    limits_rad = (
        (-2.8973, 2.8973),
        (-1.7628, 1.7628),
        (-2.8973, 2.8973),
        (-3.0718, -0.0698),
        (-2.8973, 2.8973),
        (-0.0175, 3.7525),
        (-2.8973, 2.8973),
    )
    rows = [Joint(0.0, alpha_rad[i], a_mm[i], d_mm[i], limits_rad=limits_rad[i]) for i in range(7)]
    flange_mm, hand_mm, ball_mm = 107.0, 103.4, 30.0
    joints, probes, _ = from_modified(rows, {"ball": Probe(0.0, 0.0, flange_mm + hand_mm + ball_mm)})
    return Arm("Franka Emika Panda", joints, probes)


def ur10() -> Arm:
    """Universal Robots UR10e-class arm of the data set, six axes, with a tracker's target 109 mm before the flange."""
    return _universal("UR10", (128.0, -612.7, -571.6, 163.9, 115.7), flange_mm=92.2, target_mm=109.0)


def ur5() -> Arm:
    """Universal Robots UR5, six axes, with a tracker's reflector 31 mm before the flange.

    Denavit–Hartenberg parameters of series 3 (manual of the CB3 controller, table C.3).
    """
    return _universal("UR5", (89.159, -425.0, -392.25, 109.15, 94.65), flange_mm=82.3, target_mm=31.0)


def _universal(name: str, links_mm: Sequence[float], flange_mm: float, target_mm: float) -> Arm:
    """links_mm: d1, a2, a3, d4, d5.

    The maker's Denavit–Hartenberg parameters are the upper-joint form already. Axes 2, 3 and 4 are parallel: joints 2
    and 3 are Hayati joints, which have a tilt (beta) in place of an offset along the axis.
    """
    d1_mm, a2_mm, a3_mm, d4_mm, d5_mm = links_mm
    joints = (
        Joint(0.0, _QUARTER, 0.0, d1_mm),
        Joint(0.0, 0.0, a2_mm, model="hayati"),
        Joint(0.0, 0.0, a3_mm, model="hayati"),
        Joint(0.0, _QUARTER, 0.0, d4_mm),
        Joint(0.0, -_QUARTER, 0.0, d5_mm),
        Joint(),
    )
    return Arm(f"Universal Robots {name}", joints, {"target": Probe(0.0, 0.0, flange_mm + target_mm)})


def wam() -> Arm:
    """Barrett WAM, seven axes, with a tracker's reflector on the tool plate.

    Denavit–Hartenberg parameters of the maker's user's manual (D1001, table 5).
    """
    joints = (
        Joint(0.0, -_QUARTER, 0.0, 0.0),
        Joint(0.0, _QUARTER, 0.0, 0.0),
        Joint(0.0, -_QUARTER, 45.0, 550.0),
        Joint(0.0, _QUARTER, -45.0, 0.0),
        Joint(0.0, -_QUARTER, 0.0, 300.0),
        Joint(0.0, _QUARTER, 0.0, 0.0),
        Joint(),
    )
    return Arm("Barrett WAM", joints, {"target": Probe(0.0, 0.0, 60.0)})
