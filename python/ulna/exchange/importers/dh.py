"""A table of Denavit–Hartenberg parameters as an arm file: `ulna export dh` the other way round."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.links import hayati_where_parallel, link_at_zero, moved
from ulna.arm.frames.modified import Convention, from_modified
from ulna.arm.frames.rigid import pose, turn
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.exchange.importers.dh_table import TIP, Table, read_dh
from ulna.exchange.importers.urdf import base_remark, commented
from ulna.formats.output import refuse_inputs, write_file
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: of an arm, all its lengths together: beyond that another unit is rather meant
SHORTEST_MM, LONGEST_MM = 10.0, 15_000.0
#: of a right angle: so near to one is one that was rounded
_ALIKE = 0.01
_STANDS = {
    "dh": "alpha and a of a row stand behind its joint (dh).",
    "modified-dh": "alpha and a of a row stand before its joint (modified-dh).",
}


@dataclass(frozen=True)
class Imported:
    """An arm, and what should be known of how it was made."""

    arm: Arm
    remarks: list[str]
    taken: str = ""
    """What of the file was taken for what, in one sentence."""


def import_dh(
    path: Path,
    out: Path,
    convention: Convention,
    length: str | None = None,
    angle: str | None = None,
    tip: tuple[float, float, float] | None = None,
    force: bool = False,
) -> Imported:
    """Write the arm file. Units are those in the columns' names (`a_mm`), else `length` and `angle`.

    `tip` is the probe's tip in the last row's frame, in the table's unit of length; without it, and without rows `tip`,
    it is the origin of that frame. Raises UlnaInputError; nothing is written then.
    """
    refuse_inputs([out], [path])
    found = arm_from_table(read_dh(path, length, angle), convention, tip)
    write_file(
        out,
        commented(found.arm, [f"Made of {path.name}, convention {convention}. {found.taken}", *found.remarks]),
        force=force,
    )
    return found


def arm_from_table(table: Table, convention: Convention, tip: tuple[float, float, float] | None = None) -> Imported:
    """The arm that a table describes. Raises UlnaInputError for what the convention has no place for."""
    frames = _tip_frames(table, convention, tip)
    if convention == "dh":
        *links, last = table.joints
        bare = replace(last, theta0_rad=0.0, alpha_rad=0.0, a_mm=0.0, d_mm=0.0, beta_rad=0.0, model="dh")
        joints, probes, base = (*links, bare), moved(frames, link_at_zero(last)), np.eye(4)
    else:
        for k, row in enumerate([*table.joints, *table.tips.values()], start=1):
            if row.beta_rad:
                raise UlnaInputError(
                    f"{table.path}: row {k}, column 'beta': got {row.beta_rad:g} rad, which the modified form does not "
                    "have; expected 0. Give the table with --convention dh if it is one, or make it 0."
                )
        joints, probes, base = from_modified(table.joints, frames)
    joints, probes, changed = hayati_where_parallel(joints, probes)
    remarks = doubts(table)
    parallel = [str(k) for k in changed if joints[k - 1].model == "hayati"]
    if parallel:
        remarks.append(
            f"Hayati joints, because the next axis is (nearly) parallel: {', '.join(parallel)}. An offset d of theirs "
            "is in the next joint's, or in the tips; the arm is the same."
        )
    opened = [str(k) for k in changed if joints[k - 1].model == "dh"]
    if opened:
        remarks.append(
            f"DH joints, because an offset of the joint before came to them and the next axis is far from parallel: "
            f"{', '.join(opened)}. A d is in place of their beta; the arm is the same."
        )
    if not np.array_equal(base, np.eye(4)):
        remarks.append(base_remark(base, "of the table"))
    taken = f"Read: {table.taken}. {_STANDS[convention]}"
    if not table.tips:
        taken += " The tip is where it was said to be." if tip else " The tip is the origin of the last row's frame."
    return Imported(Arm(table.path.stem, joints, probes), remarks, taken)


def doubts(table: Table) -> list[str]:
    """Questions about units that can hardly be what was meant."""
    rows = [*table.joints, *table.tips.values()]
    reach_mm = sum(abs(row.a_mm) + abs(row.d_mm) for row in rows)
    found = []
    if reach_mm and not SHORTEST_MM <= reach_mm <= LONGEST_MM:
        found.append(f"All lengths together are {reach_mm:.6g} mm, for an arm: is their unit right?")
    twists = [row.alpha_rad for row in rows if row.alpha_rad]
    as_degrees = [math.degrees(twist) for twist in twists]
    if twists and all(abs(each / (math.pi / 2) - round(each / (math.pi / 2))) < _ALIKE for each in as_degrees):
        shown = ", ".join(f"{each:g}" for each in dict.fromkeys(round(each, 9) for each in as_degrees))
        found.append(f"alpha is {shown} degrees, and right angles are that in rad: is the unit of angles right?")
    return found


def _tip_frames(table: Table, convention: Convention, tip: tuple[float, float, float] | None) -> dict[str, Probe]:
    """The tips in the last joint's frame."""
    if tip is not None and table.tips:
        raise UlnaInputError(
            f"{table.path}: got --tip, but the table has rows for tips ({', '.join(table.tips)}); expected one of the "
            "two. Leave out --tip."
        )
    if table.tips:
        at_end = link_at_zero if convention == "dh" else _modified_link
        return {name: Probe(*at_end(row)[:3, 3].tolist()) for name, row in table.tips.items()}
    if tip is not None and not all(math.isfinite(value) for value in tip):
        raise UlnaInputError(f"{table.path}: --tip: got {tip}; expected three finite numbers. Correct it.")
    if tip is not None and table.mm is None:
        raise UlnaInputError(
            f"{table.path}: the columns a and d have different units; expected one, in which --tip is. Change one."
        )
    return {TIP: Probe(*(value * (table.mm or 1.0) for value in tip or (0.0, 0.0, 0.0)))}


def _modified_link(row: Joint) -> F64:
    """`Rx(alpha) · Tx(a) · Rz(-theta0) · Tz(d)`."""
    r = turn("x", row.alpha_rad)
    before = pose(r, np.array([row.a_mm, 0.0, 0.0]))
    return before @ pose(turn("z", -row.theta0_rad), np.array([0.0, 0.0, row.d_mm]))
