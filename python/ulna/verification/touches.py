"""What was touched in an acceptance test: encoder readings through an arm, or x, y, z of any arm. Lengths mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.conditions import CONDITIONS
from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.own_units import LENGTHS, LENGTHS_STATED, check_units
from ulna.formats.table import file_sha256, read_header, read_table
from ulna.formats.units import Units
from ulna.formats.unused import remark_strange
from ulna.ground.arrays import F64, I64, Texts
from ulna.ground.errors import UlnaInputError
from ulna.study.readings.checks import check_scale, remark_limits
from ulna.study.readings.columns import ReadingsEntry, Source, check_columns, codes, each_row, is_numeric, known_columns
from ulna.study.readings.conditions import is_condition, said_of
from ulna.study.readings.payloads import carried_in
from ulna.study.readings.readings import angle_factors, angles
from ulna.verification.tables import TouchKeys

WHAT = "touches (a table with the columns x, y, z, or q1, q2, …)"
LABELS = ("test", "artefact", "position", "orientation", "repeat", "feature")
XYZ = ("x", "y", "z")
#: of the list that an operator follows; nothing is computed from them
LISTED = ("step", "what to do")


@dataclass(frozen=True)
class Touches:
    """One file's touches."""

    path: Path
    sha256: str
    source: Literal["encoders", "xyz"]
    labels: dict[str, Texts]
    """Each of LABELS: (N,) str, "" where nothing is said."""
    p_mm: F64
    """(N, 3) centre of the probe's ball, or points of the surface where the ball's diameter is 0."""
    ball_mm: F64
    """(N,) diameter of the probe's ball; NaN where it is not known."""
    row: I64
    """(N,) number in the file."""
    arm_sha256: str | None = None
    """Of the file of the arm that made points of encoder readings."""

    def where(self, chosen: I64) -> Touches:
        """Some of them."""
        labels = {name: column[chosen] for name, column in self.labels.items()}
        return Touches(
            self.path, self.sha256, self.source, labels, self.p_mm[chosen], self.ball_mm[chosen], self.row[chosen]
        )

    def groups(self, names: Sequence[str]) -> list[tuple[tuple[str, ...], Touches]]:
        """The touches that have the labels `names` in common, in the order in which they appear."""
        keys = (
            list(zip(*(self.labels[name].tolist() for name in names), strict=True)) if names else [()] * len(self.row)
        )
        found: dict[tuple[str, ...], list[int]] = {}
        for k, key in enumerate(keys):
            found.setdefault(key, []).append(k)
        return [(key, self.where(np.array(rows, dtype=np.int64))) for key, rows in found.items()]


def joined(parts: Sequence[Touches]) -> Touches:
    """Of several files as one; the path is that of the first."""
    labels = {name: np.concatenate([part.labels[name] for part in parts]) for name in LABELS}
    first = parts[0]
    return Touches(
        first.path,
        first.sha256,
        first.source,
        labels,
        np.concatenate([part.p_mm for part in parts]),
        np.concatenate([part.ball_mm for part in parts]),
        np.concatenate([part.row for part in parts]),
    )


@dataclass(frozen=True)
class Setting:
    """What a verify file, or a protocol, says of all its readings."""

    path: Path
    units: Units
    ball_mm: float | None
    temperature_c: float | None
    arm_by: str = "expected `ulna verify ARM PLAN`. Name the arm's file"
    """What to do where no arm is named."""
    table: str = "[[readings]]"
    """How messages call what says how readings are written."""


def read_touches(
    path: Path,
    entry: TouchKeys,
    key: str,
    setting: Setting,
    arm: Arm | None,
    arm_file: Path | None,
    remarks: list[str],
) -> Touches:
    """One file; key: that of its table, `readings.2`. Raises UlnaInputError."""
    layout = Layout.of(entry, (f"{setting.path}: key '{key}.", "'"), setting.table)
    joints = 0 if arm is None else arm.n
    header = read_header(path, WHAT, layout, [*known_columns(joints, True), *LABELS])
    encoders = [column for column in header.columns if column[0] == "q" and column[1:].isdecimal()]
    if encoders and arm is None:
        raise UlnaInputError(
            f"{path}: the columns {encoders[0]} … are encoder readings, but no arm is named; "
            f"{setting.arm_by}, or give readings as x, y, z."
        )
    if encoders and any(axis in header.columns for axis in XYZ):
        raise UlnaInputError(
            f"{path}: there are encoder columns ({encoders[0]}, …) and coordinates as well; expected one of them. "
            "Remove the columns that are not meant."
        )
    known = [*LABELS, *LISTED, *XYZ] if not encoders else [*LABELS, *LISTED, *known_columns(joints, False)]
    remark_strange(header, known, [*LABELS, *([] if encoders else XYZ)], remarks)
    if not encoders:
        return _coordinates(header, entry, setting, remarks)
    assert arm is not None
    assert arm_file is not None
    check_columns(header, arm.n, arm.name, [], asked=header.columns)
    needed = [
        *_labels_of(header),
        *encoders,
        *(c for c in header.columns if c == "probe" or is_condition(c)),
    ]
    frame = _filled(header, needed)
    row = np.arange(1, len(frame) + 1)
    reading = ReadingsEntry(file=path.name, angle=entry.angle, probe=entry.probe, payload=entry.payload)
    source = Source(setting.path, key, reading, 0, arm_file)
    factors = angle_factors(source, arm, setting.units)
    q_rad = angles(frame, "q", factors)
    check_scale(q_rad, "q", arm, factors, entry.angle or setting.units.angle, header, row)
    probe = each_row(codes(frame, header, source, "probe", list(arm.probes), f"arm '{arm.name}'", row), len(row))
    said: dict[str, Any] = said_of(frame, arm.n, header, row) | carried_in(frame, header, source, arm, row)
    said = {each.said: said.get(each.said) for each in CONDITIONS}
    if said["temperature_c"] is None:
        said["temperature_c"] = setting.temperature_c
    conditions = arm.conditions(len(row), **said)
    balls = np.array([np.nan if each.ball_mm is None else each.ball_mm for each in arm.probes.values()])
    _remark_repeats(q_rad, header, remarks)
    remark_limits(q_rad, row, "q", arm, path, remarks)
    p_mm = arm.core.tip(q_rad, probe, **conditions)
    return Touches(path, file_sha256(path), "encoders", _labels(frame, entry, len(row)), p_mm, balls[probe], row)


def _coordinates(header: Header, entry: TouchKeys, setting: Setting, remarks: list[str]) -> Touches:
    missing = [axis for axis in XYZ if axis not in header.columns]
    if missing:
        raise UlnaInputError(
            f"{header.path}: the column '{missing[0]}' is missing: the file has {', '.join(header.columns)[:80]}; "
            "expected x, y, z, or the encoder columns q1, q2, …. Map the file's columns with the key 'columns', or "
            "correct the header."
        )
    for key in ("angle", "probe", "payload", "arm"):
        if getattr(entry, key, None) is not None:
            raise UlnaInputError(
                f"{setting.path}: key 'readings.{key}': {header.path} holds coordinates; expected it with encoder "
                "readings only. Remove it."
            )
    check_units(header, XYZ, setting.units.length, LENGTHS, LENGTHS_STATED)
    frame = _filled(header, [*_labels_of(header), *XYZ])
    p_mm = np.ascontiguousarray(frame.select(XYZ).to_numpy(), dtype=np.float64) * setting.units.mm
    ball_mm = np.full(len(frame), np.nan if setting.ball_mm is None else setting.ball_mm)
    labels = _labels(frame, entry, len(frame))
    _remark_repeats(p_mm, header, remarks)
    return Touches(header.path, file_sha256(header.path), "xyz", labels, p_mm, ball_mm, np.arange(1, len(frame) + 1))


def _remark_repeats(values: F64, header: Header, remarks: list[str]) -> None:
    """No two touches are the same to the last digit: a row that is there twice was copied."""
    _, first, count = np.unique(values, axis=0, return_index=True, return_counts=True)
    if (count > 1).any():
        row = int(first[count > 1].min())
        same = np.flatnonzero((values == values[row]).all(axis=1)) + 1
        extra = int((count - 1).sum())
        remarks.append(
            f"{header.path}: {extra} row{'s repeat' if extra > 1 else ' repeats'} another one to the last digit, first "
            f"rows {', '.join(map(str, same[:4].tolist()))}: all are used."
        )


def _filled(header: Header, columns: Sequence[str]) -> pl.DataFrame:
    frame = read_table(header, is_numeric, columns, LABELS)
    if not len(frame):
        raise UlnaInputError(f"{header.path}: there are no rows; expected a touch in each. Add them.")
    return frame


def _labels_of(header: Header) -> list[str]:
    return [name for name in LABELS if name in header.columns]


def _labels(frame: pl.DataFrame, entry: TouchKeys, count: int) -> dict[str, Texts]:
    """The file's own cells; of empty ones, and of columns that are missing, what the verify file says."""
    found = {}
    for name in LABELS:
        given = getattr(entry, name) or ""
        if name in frame.columns:
            cells = frame[name].to_numpy().astype(object)
            found[name] = np.where(cells == "", given, cells)
        else:
            found[name] = np.full(count, given, dtype=object)
    return found
