"""An arm as a table of Denavit–Hartenberg parameters (CSV), for the engineer of a controller.

One row for each joint, then one for the tip of each probe: a fixed frame that no encoder turns, in the same convention.
Units stand in the names of the columns.
"""

from __future__ import annotations

import csv
import io
import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.links import moved
from ulna.arm.frames.modified import Convention, to_modified
from ulna.arm.frames.pure import LARGE_MM, pure_dh
from ulna.arm.frames.rigid import pose, turn
from ulna.arm.given import ArmLike, as_arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.formats.units import MM_PER, RAD_PER, AngleUnit, LengthUnit
from ulna.ground.errors import UlnaInputError

#: what stands in the column `joint` of a row that is no joint
TIP = "tip"


def without_beta(arm: Arm) -> tuple[Arm, list[str]]:
    """The same arm with DH joints in place of Hayati joints, where axes have a common normal; and what to say of it."""
    joints, probes, kept = pure_dh(arm.joints, arm.probes, arm.full_last_link)
    said = []
    changed = [k for k, joint in enumerate(arm.joints, start=1) if joint.beta_rad and k not in kept]
    far_mm = max((abs(joint.d_mm) for joint in joints), default=0.0)
    if changed and far_mm > LARGE_MM:
        said.append(
            f"the axes of joints {', '.join(map(str, changed))} are nearly parallel to the next, so that offsets d are "
            f"as large as {far_mm / 1000.0:.3g} m and cancel: give the controller all digits. With --hayati the table "
            "has a column beta instead."
        )
    if kept:
        said.append(
            f"joints {', '.join(map(str, kept))} keep a column beta: their axes are too nearly parallel to the next "
            "for an offset d. A controller without beta cannot take it; hold beta at 0 in the calibration."
        )
    return replace(arm, joints=joints, probes=probes, uncertainty=None), said


def dh_table(
    arm: ArmLike, convention: Convention, path: Path, length: LengthUnit = "mm", angle: AngleUnit = "rad"
) -> str:
    """The text of the table; `path` is the arm's file, for messages.

    Columns joint, name, sign, theta0, alpha, a, d, where a joint is a Hayati joint also beta, where one is prismatic
    also type, lower and upper, units behind an underscore. turn = sign * encoder - theta0. Raises UlnaInputError for a
    beta in the modified form.
    """
    arm = as_arm(arm)
    tilted = [k for k, joint in enumerate(arm.joints, start=1) if joint.beta_rad]
    if tilted and convention == "modified-dh":
        raise UlnaInputError(
            f"{path}: key 'joint.{tilted[0]}.beta': got {arm.joints[tilted[0] - 1].beta_rad:g} rad, which a modified "
            "table has no column for; expected joints without beta. Export without --hayati or with --convention dh, "
            f'or calibrate with hold = ["joint.*.beta"] from an arm in which it is 0.'
        )
    joints, probes, tip_row = list(arm.joints), arm.probes, _tip
    if convention == "modified-dh":
        last = arm.joints[-1]  # what it may have of a link stands behind the last row
        after = pose(turn("x", last.alpha_rad), np.array([last.a_mm, 0.0, 0.0]))
        joints, probes, tip_row = to_modified(arm.joints), moved(arm.probes, after), _modified_tip
    named = [(str(k), joint.name or f"joint {k}", joint) for k, joint in enumerate(joints, start=1)]
    named += [(TIP, name, tip_row(probe)) for name, probe in probes.items()]
    columns = [f"theta0_{angle}", f"alpha_{angle}", f"a_{length}", f"d_{length}"]
    columns += [f"beta_{angle}"] * bool(tilted)
    slides = bool(arm.slides.any())
    columns += ["type", f"lower_{length}", f"upper_{length}"] * slides
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["joint", "name", "sign", *columns])
    for label, name, row in named:
        values = [row.theta0_rad / RAD_PER[angle], row.alpha_rad / RAD_PER[angle]]
        values += [row.a_mm / MM_PER[length], row.d_mm / MM_PER[length]]
        values += [row.beta_rad / RAD_PER[angle]] * bool(tilted)
        low, high = (row.slides and row.limits_rad) or (0.0, 0.0)
        kind = "fixed" if label == TIP else row.type
        travel = [kind, _number(low / MM_PER[length]), _number(high / MM_PER[length])] * slides
        writer.writerow([label, name, row.sign, *map(_number, values), *travel])
    return stream.getvalue()


def _tip(probe: Probe) -> Joint:
    """The tip at the end of a link: `Rz(-theta0) · Tz(d) · Tx(a)`, the literature's theta0, h and r."""
    theta0_rad, r_mm, h_mm = probe.cylindrical
    return Joint(theta0_rad, 0.0, r_mm, h_mm)


def _modified_tip(probe: Probe) -> Joint:
    """The tip in a frame after the last joint's: `Rx(alpha) · Tx(a) · Tz(d)`."""
    if not probe.y_mm:
        return Joint(0.0, 0.0, probe.x_mm, probe.z_mm)
    return Joint(0.0, math.atan2(-probe.y_mm, probe.z_mm), probe.x_mm, math.hypot(probe.y_mm, probe.z_mm))


def _number(value: float) -> str:
    return repr(float(value) + 0.0)
