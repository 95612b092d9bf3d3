"""The two arms that every way calibrates, and the bar that judges them. Angles rad, lengths mm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.reproduce.cheng2011.arms import BAR_MM, BENT_PROBE, STRAIGHT_PROBE, platinum, virtual
from ulna.simulation.reading_errors import ReadingErrors
from ulna.simulation.virtual_arm import VirtualArm

BAR_ENDS_MM = np.array([[0.0, 0.0, 0.0], [BAR_MM, 0.0, 0.0]])

SEVEN, SIX = "seven axes", "six axes"
ARMS = (SEVEN, SIX)


def true_arm(name: str, straight: bool = False) -> VirtualArm:
    """The arm of Cheng's Table 4 with its bent or its straight probe; of six axes: its last swivel locked at zero."""
    seven = virtual(platinum(STRAIGHT_PROBE if straight else BENT_PROBE))
    if name == SEVEN:
        return replace(seven, arm=replace(seven.arm, name=SEVEN))
    errors = ReadingErrors(seven.errors.encoder_rad[:6], seven.errors.seat_mm)
    return VirtualArm(_locked(seven.arm), seven.travel_rad[:6], errors)


def _locked(seven: Arm) -> Arm:
    """Six joints; the sixth link and the probe are one rigid body that turns with the sixth joint."""
    body = Arm("sixth link and probe", seven.joints[5:], seven.probes)
    x_mm, y_mm, z_mm = body.tip(np.zeros((1, 2)))[0].tolist()
    return Arm(SIX, (*seven.joints[:5], Joint()), {"bent": Probe(x_mm, y_mm, z_mm)})


__all__ = ["ARMS", "BAR_ENDS_MM", "BAR_MM", "SEVEN", "SIX", "true_arm"]
