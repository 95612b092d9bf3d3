"""Readings: tables of any format, one touch a row (or, for lengths, two poses a row), as arrays in mm and rad."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.labels import Labels
from ulna.artefacts.readings import InputFile, Readings
from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.own_units import LENGTHS, LENGTHS_STATED, check_units
from ulna.formats.rows import Rows, Selection
from ulna.formats.table import file_sha256, named_header, read_header, read_table
from ulna.formats.units import RAD_PER, Units
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.study.readings.checks import check_ids, check_scale
from ulna.study.readings.columns import (
    ReadingsEntry,
    Source,
    check_columns,
    codes,
    each_row,
    ignored_columns,
    is_numeric,
    known_columns,
    remark_unused,
)
from ulna.study.readings.conditions import approach_by_order, said_of
from ulna.study.readings.own_points import has_own_points, own_points
from ulna.study.readings.payloads import carried_in
from ulna.study.readings.turned import said_of_target

WHAT = "a readings file (CSV with a header q1,q2,…, Parquet, .xlsx, .mat or HDF5)"

#: names that only some artefacts need: a ball has no features, a seat just one
NAMELESS = ("feature",)


def read_readings(
    source: Source,
    arm: Arm,
    artefacts: dict[str, Artefact],
    units: Units,
    remarks: list[str],
    which: Rows = "fit",
) -> tuple[list[Readings], InputFile]:
    """One file's readings, a part for each artefact in it. Raises UlnaInputError; remarks are added to."""
    path = source.study.parent / source.entry.file
    frame, row, header, rows = _table(path, source, arm, artefacts, remarks, which)
    artefact = codes(frame, header, source, "artefact", list(artefacts), f"{source.study}", row)
    parts: list[Readings] = []
    check_ids(frame, row, header)
    for index in np.unique(artefact).tolist() if isinstance(artefact, np.ndarray) else [artefact]:
        chosen = list(artefacts.values())[index]
        own = np.flatnonzero(artefact == index) if isinstance(artefact, np.ndarray) else np.arange(len(frame))
        part = frame if len(own) == len(frame) else frame[own]
        parts.append(_part(part, row[own], chosen, header, source, arm, units, remarks))
    digest = file_sha256(path) if source.table is None else source.table.sha256
    return parts, InputFile(path, digest, rows, header.row_places)


def _table(
    path: Path, source: Source, arm: Arm, artefacts: dict[str, Artefact], remarks: list[str], which: Rows
) -> tuple[pl.DataFrame, I64, Header, int]:
    """The columns that are known, of the rows that are used; (N,) those rows' numbers in the file; the number of all
    its rows. Raises UlnaInputError."""
    entry = source.entry
    place = f"{source.study}: key '{source.key}"
    layout = Layout.of(entry, (f"{place}.", "'"), "[[readings]]")
    coordinates = any(map(has_own_points, artefacts.values()))
    turned = any(kind_of(artefact).turned for artefact in artefacts.values())
    known = known_columns(arm.n, coordinates, turned)
    header = (
        read_header(path, WHAT, layout, known) if source.table is None else named_header(source.table, layout, known)
    )
    _check_approach(entry, header, place)
    by_order = entry.approach == "order"
    selection = Selection(entry.where or {}, entry.split, which, place)
    asked = list(dict.fromkeys(selection.columns(header).values()))
    ignored = ignored_columns(header, entry.ignore or (), f"{place}.ignore'")
    needed = check_columns(header, arm.n, arm.name, remarks, coordinates, [*asked, *ignored], turned)
    needed = [column for column in needed if column not in ignored]
    if asked:
        texts = header.cells(lambda _: False, asked)
        chosen, rows = selection.of(texts, header, remarks), len(texts)
        row = chosen + 1
        every = header.cells(is_numeric, needed)
        if len(every) != rows:  # arrays in one file may be of several lengths
            raise UlnaInputError(
                f"{path}: {', '.join(map(header.own, asked))} {'have' if len(asked) > 1 else 'has'} {rows} rows, the "
                f"readings {len(every)}; expected as many where rows are chosen by them ({place}'). Correct the arrays."
            )
        if by_order:  # the row before may be none of those that are used
            whole = header.checked(every, is_numeric, np.arange(1, rows + 1), blank=NAMELESS)
            frame = _approached(whole, arm.n)[chosen]
        else:
            frame = header.checked(every[chosen], is_numeric, row, blank=NAMELESS)
    else:
        frame = read_table(header, is_numeric, needed, NAMELESS)
        frame = _approached(frame, arm.n) if by_order and len(frame) else frame
        row, rows = np.arange(1, len(frame) + 1), len(frame)
    if not rows:
        raise UlnaInputError(
            f"{path}: there are no rows; expected at least one reading. Add them or remove '{source.key}'."
        )
    return frame, row, header, rows


def _part(
    frame: pl.DataFrame,
    row: I64,
    artefact: Artefact,
    header: Header,
    source: Source,
    arm: Arm,
    units: Units,
    remarks: list[str],
) -> Readings:
    pairs, kind = "p1" in frame.columns, kind_of(artefact)
    if pairs != (kind.poses == 2):
        raise UlnaInputError(
            f"{header.path}: {header.where(int(row[0]))}: artefact '{artefact.name}' is of kind '{artefact.kind}', "
            "but the file "
            + ("gives two poses a row (columns p1, …)" if pairs else "gives one pose a row (no columns p1, …)")
            + f"; expected {'two poses' if kind.poses == 2 else 'one pose'} a row. Correct the kind or the columns."
        )
    feature: I64 | None = None
    if has_own_points(artefact):
        artefact, feature = own_points(frame, row, artefact, header, source, units, remarks)
    factors = angle_factors(source, arm, units)
    q_rad = angles(frame, "q", factors)
    check_scale(q_rad, "q", arm, factors, source.entry.angle or units.angle, header, row)
    p_rad = length_mm = None
    if pairs:
        p_rad = angles(frame, "p", factors)
        check_scale(p_rad, "p", arm, factors, source.entry.angle or units.angle, header, row)
    if kind.measured_column is not None:
        length_mm = _measured(kind.measured_column, frame, row, artefact, header, source, units)
    said: dict[str, Any] = said_of(frame, arm.n, header, row) | carried_in(frame, header, source, arm, row, remarks)
    if kind.turned:
        said |= said_of_target(frame, row, artefact, header, source)
    return Readings(
        artefact=artefact,
        q_rad=q_rad,
        p_rad=p_rad,
        length_mm=length_mm,
        probe=each_row(
            codes(frame, header, source, "probe", list(arm.probes), f"arm '{arm.name}'", row, remarks), len(row)
        ),
        feature=_features(frame, row, artefact, header, source, remarks) if feature is None else feature,
        placement=_placements(frame, row, source, header, remarks),
        row=row,
        file=np.full(len(row), source.index, dtype=np.int64),
        id=frame["id"].to_numpy().astype(object) if "id" in frame.columns else None,
        **said,
    )


def angles(frame: pl.DataFrame, letter: str, factors: F64) -> F64:
    """Columns q1 … qn (or p1 …) → (N, n) rad. They leave the frame as they are copied: the data are there once."""
    out = np.empty((len(frame), len(factors)))
    for k, factor in enumerate(factors):
        np.multiply(frame.drop_in_place(f"{letter}{k + 1}").to_numpy(), factor, out=out[:, k])
    return out


def angle_factors(source: Source, arm: Arm, units: Units) -> F64:
    """(n,) rad in one unit of the file; of prismatic joints mm in one of its units of length."""
    unit = source.entry.angle or units.angle
    if unit != "counts":
        return arm.each(RAD_PER[unit], units.mm)
    arm.check_turns(f"{source.study}: key '{source.key}.angle'", "readings in counts")
    for k, joint in enumerate(arm.joints, start=1):
        if joint.counts_per_turn is None:
            raise UlnaInputError(
                f"{source.arm_file}: key 'joint.{k}.counts_per_turn' is missing, but {source.study} says angle = "
                f"\"counts\" (key '{source.key}.angle'); expected the encoder's counts in one turn. Add it for every "
                "joint."
            )
    return np.array([2.0 * math.pi / (joint.counts_per_turn or math.nan) for joint in arm.joints])


def _measured(
    column: str, frame: pl.DataFrame, row: I64, artefact: Artefact, header: Header, source: Source, units: Units
) -> F64:
    """(N,) mm: the distance that was measured along with each row."""
    if column not in frame.columns:
        if artefact.length_mm is None:
            between = "between the two poses" if kind_of(artefact).poses == 2 else "that was measured"
            give = f", or give artefact.{artefact.name}.length in {source.study}" if column == "length" else ""
            raise UlnaInputError(
                f"{header.path}: the column '{column}' is missing; expected the distance {between} of each row, in "
                f"{units.length}. Add it{give}.{header.further}"
            )
        return np.full(len(row), artefact.length_mm)
    check_units(header, [column], units.length, LENGTHS, LENGTHS_STATED)
    lengths = frame[column].to_numpy()
    if (lengths < 0).any():
        first = int(np.argmax(lengths < 0))
        raise UlnaInputError(
            f"{header.path}: {header.at(int(row[first]), column)}: got {lengths[first]:g}, expected a "
            "distance of 0 or more. Correct it."
        )
    return lengths * units.mm


def _features(
    frame: pl.DataFrame, row: I64, artefact: Artefact, header: Header, source: Source, remarks: list[str]
) -> I64:
    if not kind_of(artefact).named:
        return np.zeros(len(row), dtype=np.int64)
    known = list(artefact.features)
    return each_row(
        codes(frame, header, source, "feature", known, f"artefact '{artefact.name}'", row, remarks), len(row)
    )


def _placements(frame: pl.DataFrame, row: I64, source: Source, header: Header, remarks: list[str]) -> Labels:
    """(N,) str. With neither column nor key the whole file is one standing; "" says so until files are merged."""
    if "placement" not in frame.columns:
        return Labels.all_alike(source.entry.placement or "", len(row))
    remark_unused(frame, header, source, "placement", remarks)
    runs = frame["placement"].rle().struct  # readings of one standing mostly follow each other
    names = runs.field("value").unique(maintain_order=True)
    code = runs.field("value").replace_strict(names, pl.int_range(len(names), eager=True), return_dtype=pl.Int64)
    return Labels(np.repeat(code.to_numpy(), runs.field("len").to_numpy()), names.to_list())


def _approached(frame: pl.DataFrame, joints: int) -> pl.DataFrame:
    """With columns that say from which side joints were approached, by the order of all rows of a file."""
    q, p = ([f"{letter}{k}" for k in range(1, joints + 1)] for letter in "qp")
    two = p[0] in frame.columns
    both = approach_by_order(frame.select(q).to_numpy(), frame.select(p).to_numpy() if two else None)
    named = {"approach": both[0], "papproach": both[1]}
    return frame.with_columns(
        pl.Series(f"{prefix}{k + 1}", np.ascontiguousarray(values[:, k]))
        for prefix, values in named.items()
        if values is not None
        for k in range(joints)
    )


def _check_approach(entry: ReadingsEntry, header: Header, place: str) -> None:
    """The file says it in the way that the study says. Raises UlnaInputError."""
    there = "approach1" in header.columns
    if entry.approach == "order" and there:
        raise UlnaInputError(
            f"{place}.approach': got 'order', but {header.path} has columns approach1, …; expected one way of saying "
            "from which side joints were approached. Remove the key or the columns."
        )
    if entry.approach == "column" and not there:
        raise UlnaInputError(
            f"{place}.approach': got 'column', but {header.path} has no columns approach1, …; expected +1, -1 or 0 for "
            "each joint there. Add them, or say 'order' where the rows are in the order of the touches."
        )
