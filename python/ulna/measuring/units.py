"""Units of the angles that are measured with."""

from __future__ import annotations

import math

import numpy as np

from ulna.arm.arm import Arm
from ulna.formats.header import Header
from ulna.formats.own_units import LENGTHS
from ulna.formats.units import MM_PER
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest

ANGLES = ("rad", "deg", "counts")


def rad_per(arm: Arm, angle: str, header: Header | None = None) -> F64:
    """(n,) rad in a unit of the angles; of prismatic joints mm in the unit that the heading of their column says, or 1
    where it says none: they are in mm. Raises UlnaInputError for one that is none, or counts of nobody knows what."""
    if angle not in ANGLES:
        raise UlnaInputError(f"measure: angle '{angle}'; expected rad, deg or counts.{nearest(angle, ANGLES)}")
    if angle != "counts":
        found = arm.each(1.0 if angle == "rad" else math.pi / 180.0, 1.0)
        for k in np.flatnonzero(arm.slides).tolist() if header is not None else ():
            said = LENGTHS.unit(header.units.get(header.own(f"q{k + 1}"), "")) if header is not None else None
            found[k] = MM_PER[said or "mm"]
        return found
    arm.check_turns("measure", "readings in counts")
    for k, joint in enumerate(arm.joints, start=1):
        if joint.counts_per_turn is None:
            raise UlnaInputError(
                f"arm '{arm.name}': key 'joint.{k}.counts_per_turn' is missing, which readings in counts need. Add it "
                "to the arm file."
            )
    return np.array([2.0 * math.pi / (joint.counts_per_turn or math.nan) for joint in arm.joints])
