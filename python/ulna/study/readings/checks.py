"""Readings that are numbers, but cannot be what was meant; and readings to be remarked upon.

Rows that repeat: the same encoder angles with the same probe at the same feature of the same placement (or the same two
poses with the same length) is a copy, remarked upon and used. The same angles at two features of one placement, or the
same two poses with two lengths, contradict each other: an error. So do two different rows with one `id`.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.joint import MOST_RAD
from ulna.artefacts.readings import InputFile, Readings
from ulna.formats.header import Header
from ulna.formats.own_units import ANGLES, LENGTHS, LENGTHS_STATED, check_units
from ulna.formats.units import MM_PER
from ulna.formats.wording import SHOWN, counted, rows_named
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError


def named_probe(probe: str | None, arm: Arm, path: Path) -> str:
    """The probe that a file's key names; the arm's only one where it names none. Raises UlnaInputError."""
    try:
        return list(arm.probes)[arm.probe_index(probe)]
    except UlnaInputError as error:
        raise UlnaInputError(f"{path}: key 'probe': {error} Correct it.") from None


def check_scale(
    q_rad: F64,
    letter: str,
    arm: Arm,
    factors: F64,
    unit: str,
    header: Header,
    row: I64,
    remedy: str = "State the unit with the key 'angle'.",
) -> None:
    """Whether angles can be in the unit that is stated. (N, n) rad; factors (n,) rad per unit; remedy: how the unit is
    stated here. Of prismatic joints mm. Raises UlnaInputError.

    An endless joint may stand anywhere, one with limits as far as they go, and every joint within two turns. Where only
    one joint is beyond, and is one that goes all the way round, it has counted turns: no matter of units, for those are
    the same for all joints, but remarked upon (`Outside`).
    """
    slides = arm.slides
    check_units(header, [f"{letter}{k + 1}" for k in np.flatnonzero(~slides)], unit, ANGLES, remedy)
    for k in np.flatnonzero(slides).tolist():
        length = next(name for name, mm in MM_PER.items() if mm == factors[k])
        check_units(header, [f"{letter}{k + 1}"], length, LENGTHS, LENGTHS_STATED)
    farthest_rad = np.abs(q_rad).max(axis=0)
    beyond = [k for k, joint in enumerate(arm.joints) if farthest_rad[k] > joint.most_rad]
    if not beyond or (len(beyond) == 1 and arm.joints[beyond[0]].goes_round):
        return
    k = beyond[0]
    joint, column = arm.joints[k], q_rad[:, k]
    first = int(np.argmax(np.abs(column) > joint.most_rad))
    expected = "angles within ±4π rad (720°) of a joint without limits"
    if joint.limits_rad is not None:
        low, high = joint.limits_rad
        expected = f"angles within the limits of joint {k + 1}, {low:g} to {high:g} rad, or ±4π rad (720°)"
    asked = {"rad": "degrees or counts", "deg": "counts", "counts": "counts, and is counts_per_turn right"}[unit]
    remedy = "Correct counts_per_turn or the column." if unit == "counts" else remedy
    alone = " and ".join(f"{letter}{each + 1}" for each in beyond) if 2 * len(beyond) < len(factors) else ""
    alone = alone and f" Only {alone} {'is' if len(beyond) == 1 else 'are'} beyond: in another unit than the rest?"
    raise UlnaInputError(
        f"{header.path}: {header.at(int(row[first]), f'{letter}{k + 1}')}: got {column[first] / factors[k]:g} {unit}, "
        f"more than two turns; expected {expected}. Are these {asked}?{alone} {remedy} If joint {k + 1} does turn that "
        "far, say so in the arm file: endless = true, or limits."
    )


def check_ids(frame: pl.DataFrame, row: I64, header: Header) -> None:
    """One id, one reading. Raises UlnaInputError where two different rows have the same id."""
    if "id" not in frame.columns or not frame["id"].is_duplicated().any():
        return
    numbered = frame.with_columns(pl.Series("row", row))
    at = numbered.unique(subset=frame.columns, keep="first", maintain_order=True)
    again = at.filter(pl.col("id").is_duplicated())
    if len(again):
        value = again["id"][0]
        first, second = again.filter(pl.col("id") == value)["row"][:2].to_list()
        raise UlnaInputError(
            f"{header.path}: {header.at(second, 'id')}: '{value}' stands in row {first} already, with other "
            "values; expected one reading per id. Correct or remove one of them."
        )


def check_limits(group: Readings, arm: Arm, files: list[InputFile], remarks: list[str]) -> None:
    """Remark upon readings outside a joint's limits."""
    for letter, q_rad in (("q", group.q_rad), ("p", group.p_rad)):
        if q_rad is None:
            continue
        for index in np.unique(group.file).tolist():
            own = group.file == index
            remark_limits(q_rad[own], group.row[own], letter, arm, files[index].path, remarks)


def remark_limits(q_rad: F64, row: I64, letter: str, arm: Arm, path: Path, remarks: list[str]) -> None:
    """The same of (N, n) readings of one file, in the rows (N,) and the columns q1 … or p1 … of it."""
    outside = Outside(arm, letter)
    outside.add(q_rad, row)
    remarks += outside.remarks(path)


class Outside:
    """Readings of one file outside the limits of an arm's joints, gathered from as many pieces as it comes in."""

    def __init__(self, arm: Arm, letter: str) -> None:
        self._joints, self._letter = arm.joints, letter
        self._count = [0] * arm.n
        self._first: list[list[int]] = [[] for _ in arm.joints]
        self._farthest = [(0.0, 0.0, 0)] * arm.n

    def add(self, q_rad: F64, row: I64) -> None:
        """(N, n) more readings, in the rows (N,)."""
        for k, joint in enumerate(self._joints):
            if joint.limits_rad is None:
                continue
            low, high = joint.limits_rad
            column = q_rad[:, k]
            rows = np.flatnonzero((column < low) | (column > high))
            if not len(rows):
                continue
            off_rad = np.maximum(low - column[rows], column[rows] - high)
            worst = int(np.argmax(off_rad))
            found = (float(off_rad[worst]), float(column[rows[worst]]), int(row[rows[worst]]))
            self._farthest[k] = max(self._farthest[k], found, key=lambda each: each[0])
            self._count[k] += len(rows)
            self._first[k] += row[rows[: SHOWN + 1 - len(self._first[k])]].tolist()

    def remarks(self, path: Path) -> list[str]:
        """What is said of them, joint by joint."""
        said = []
        for k, joint in enumerate(self._joints):
            if joint.limits_rad is None or not self._count[k]:
                continue
            low, high = joint.limits_rad
            _, value, at = self._farthest[k]
            said.append(
                f"{path}: column '{self._letter}{k + 1}': {counted(self._count[k], 'reading')} outside the "
                f"limits of joint {k + 1} ({low:g} to {high:g} {joint.unit}): {rows_named(np.array(self._first[k]))}; "
                f"the farthest is {value:.6g} {joint.unit} in row {at}. Check the limits in the arm file, or the "
                "readings."
                + " A joint that turns on and on has endless = true in place of limits."
                * (not joint.slides and abs(value) > MOST_RAD)
            )
        return said


def check_repeats(group: Readings, files: list[InputFile], remarks: list[str], own_points: bool = False) -> None:
    """Remark upon copies of a reading; raise UlnaInputError for readings that contradict each other.

    own_points: every reading touched a point of its own, measured along with it: that two differ is no contradiction.
    """
    candidates = _same_angles(group)
    first_of: dict[bytes, list[int]] = defaultdict(list)
    for k in candidates.tolist():
        key = group.q_rad[k].tobytes() + (b"" if group.p_rad is None else group.p_rad[k].tobytes())
        first_of[key + group.probe[k].tobytes()].append(k)
    copies: list[tuple[int, int]] = []
    points = list(group.artefact.features.values())
    for rows in first_of.values():
        seen: dict[object, int] = {}
        for k in rows:
            standing = group.placement[k] if group.artefact.frame == "free" else ""
            where = (standing, points[group.feature[k]] if own_points else None)
            first = seen.setdefault(where, k)
            if first == k:
                continue
            if group.length_mm is not None and group.length_mm[k] != group.length_mm[first]:
                raise _contradiction(group, files, first, k, "length", "the same two poses")
            if group.feature[k] != group.feature[first] and not own_points:
                raise _contradiction(group, files, first, k, "feature", "the same encoder angles")
            copies.append((k, first))
    copies.sort()
    for index in sorted({int(group.file[k]) for k, _ in copies}):
        own = [(k, first) for k, first in copies if group.file[k] == index]
        named = [f"{group.row[k]} (as {_place(group, files, first, index)})" for k, first in own[:SHOWN]]
        remarks.append(
            f"{files[index].path}: {counted(len(own), 'row')} of artefact '{group.artefact.name}' "
            f"repeat{'s' * (len(own) == 1)} another exactly: row{'s' * (len(own) > 1)} "
            f"{', '.join(named)}{', …' if len(own) > SHOWN else ''}. They count as readings of their own; remove them "
            "if they are copies."
        )


def _same_angles(group: Readings) -> I64:
    """Indices of rows whose angles are those of another row, up to rare accidents of the hash."""
    mixed = group.probe.astype(np.uint64)
    for q_rad in (group.q_rad, group.p_rad):
        for column in () if q_rad is None else q_rad.T:
            mixed = (mixed ^ np.ascontiguousarray(column).view(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
            mixed ^= mixed >> np.uint64(29)
    order = np.argsort(mixed, kind="stable")
    equal = mixed[order][1:] == mixed[order][:-1]
    marked = np.zeros(len(mixed), dtype=bool)
    marked[order[1:][equal]] = True
    marked[order[:-1][equal]] = True
    return np.flatnonzero(marked)


def _contradiction(
    group: Readings, files: list[InputFile], first: int, k: int, column: str, same: str
) -> UlnaInputError:
    index = int(group.file[k])
    names = list(group.artefact.features)
    values = [
        f"'{names[group.feature[row]]}'" if column == "feature" else f"{(group.length_mm[row]):g} mm"  # type: ignore[index]
        for row in (k, first)
    ]
    return UlnaInputError(
        f"{files[index].path}: row {group.row[k]}, column '{column}': got {values[0]}, but "
        f"{_place(group, files, first, index)} has {same} with {values[1]}; expected one {column} for one reading. "
        "Correct or remove one of the two rows."
    )


def _place(group: Readings, files: list[InputFile], k: int, index: int) -> str:
    other = int(group.file[k])
    return f"row {group.row[k]}" + ("" if other == index else f" of {files[other].path}")
