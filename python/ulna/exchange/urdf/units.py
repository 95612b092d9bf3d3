"""Whether a drawing can be in the units of a URDF, m and rad, or in those that the user states."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.arm.joint import MOST_RAD
from ulna.exchange.urdf.chain import Chain, Step
from ulna.formats.units import MM_PER, RAD_PER
from ulna.ground.errors import UlnaInputError

#: a chain longer than this, m, is rather one in mm or inches: the longest robots reach 5 m
LONGEST_M = 15.0


def in_units(chain: Chain, length_unit: str | None = None, angle_unit: str | None = None) -> Chain:
    """The chain, its lengths (and the centres of masses) read in `length_unit`, its joints' limits in `angle_unit`.

    Where a unit is not stated it is that of a URDF, m or rad, and what cannot be in it is asked about: UlnaInputError.
    """
    if length_unit is None:
        reach_m = sum(float(np.linalg.norm(step.t_parent_joint[:3, 3])) for step in chain.steps) / 1000.0
        if reach_m > LONGEST_M:
            raise UlnaInputError(
                f"{chain.path}: its links are {reach_m:.6g} m long in all, up to link '{chain.tip_link}'; expected an "
                "arm. Is it drawn in mm or inches, though a URDF is in m? Say so: --length-unit mm (or in; m if it is "
                "that long)."
            )
    if angle_unit is None:
        for step in chain.steps:
            if step.limits_rad is not None and not step.slides and max(map(abs, step.limits_rad)) > MOST_RAD:
                low, high = step.limits_rad
                raise UlnaInputError(
                    f"{chain.path}: joint '{step.name}', limit: got {low:g} to {high:g} rad, more than two turns; "
                    "expected limits in rad. Are these degrees? Say so: --angle-unit deg (or rad if it does turn that "
                    "far)."
                )
    mm, rad = MM_PER[length_unit or "m"] / 1000.0, RAD_PER[angle_unit or "rad"]
    return replace(chain, steps=tuple(_scaled(step, mm, rad) for step in chain.steps))


def _scaled(step: Step, length: float, angle: float) -> Step:
    t = step.t_parent_joint.copy()
    t[:3, 3] *= length
    x, y, z = (length * value for value in step.mass.centre_mm)
    limits, unit = step.limits_rad, length if step.slides else angle
    return replace(
        step,
        t_parent_joint=t,
        mass=replace(step.mass, centre_mm=(x, y, z)),
        limits_rad=None if limits is None else (unit * limits[0], unit * limits[1]),
    )
