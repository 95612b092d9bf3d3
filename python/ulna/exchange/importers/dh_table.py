"""Reading a table of Denavit–Hartenberg parameters (CSV), as makers and controllers give it.

Columns theta0 (or offset, which is -theta0), alpha, a, d; perhaps beta, sign, joint and name; where joints slide also
type, lower and upper. A row for each joint, from the base; rows behind them whose `joint` is `tip` are frames that no
encoder turns.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import polars as pl

from ulna.arm.joint import MOST_RAD, Joint
from ulna.formats.cells import is_decimal_comma
from ulna.formats.header import Header
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.names import check_name
from ulna.formats.own_units import ANGLES as OWN_ANGLES
from ulna.formats.own_units import LENGTHS as OWN_LENGTHS
from ulna.formats.table import read_header, read_table
from ulna.formats.tables.marks import is_text
from ulna.formats.toml import read_bytes
from ulna.formats.units import MM_PER, RAD_PER
from ulna.ground.errors import UlnaInputError

WHAT = "a table of Denavit–Hartenberg parameters (CSV with a header theta0 or offset, alpha, a, d)"

ANGLES, LENGTHS = ("theta0", "offset", "alpha", "beta"), ("a", "d", "lower", "upper")
LABELS = ("joint", "name", "type")

#: no arm is longer; a wrong unit makes it so
MOST_MM = 1e6

#: what stands in the column `joint` of a row that is no joint
TIP = "tip"


@dataclass(frozen=True)
class Table:
    """The rows as they stand, mm and rad."""

    path: Path
    joints: list[Joint]
    tips: dict[str, Joint]
    """By the probe's name: the frame whose origin is its tip."""
    mm: float | None
    """mm in a unit of length of the table; None where its columns have several."""
    taken: str
    """Which column was taken for what, in which unit."""


@dataclass(frozen=True)
class _Column:
    """A column of numbers: which parameter it is, and how many rad or mm a unit of it is."""

    name: str
    parameter: str
    factor: float

    @property
    def unit(self) -> str:
        units = RAD_PER if self.parameter in ANGLES else MM_PER
        return next(unit for unit, factor in units.items() if factor == self.factor)


def read_dh(path: Path, length: str | None = None, angle: str | None = None) -> Table:
    """The rows of a table. A unit is that in the column's name (`a_mm`), or `length` or `angle`; never guessed.

    Raises UlnaInputError naming column, row and value of what cannot be used.
    """
    return dh_of(read_header(path, WHAT, _written(path)), length, angle)


def _written(path: Path) -> Layout:
    """How the table is written, where that is certain: semicolons in its first line and no comma there."""
    start = read_bytes(path, WHAT, limit=1 << 16)
    if not is_text(start):
        return AS_EXPECTED
    lines = start.decode("latin-1").splitlines()
    if not lines or ";" not in lines[0] or "," in lines[0]:
        return AS_EXPECTED
    comma = any(is_decimal_comma(cell) for line in lines[1:] for cell in line.split(";"))
    return Layout.of_options(separator=";", decimal="," if comma else ".")


def dh_of(header: Header, length: str | None = None, angle: str | None = None) -> Table:
    """The same of a table that is open already. Raises UlnaInputError."""
    there = {name: name.casefold() for name in header.columns}
    known_names = (*LABELS, "sign")
    header = header.renamed({o: own for o, own in there.items() if own in known_names and own not in header.columns})
    columns = [_column(name, header, length, angle) for name in header.columns if name not in (*LABELS, "sign")]
    known = [column.parameter for column in columns]
    _check_known(header, known)
    numbers = {column.name for column in columns} | {"sign"}
    frame = read_table(header, lambda name: name in numbers)
    rows = [
        _typed(header, k, _row(header, k, cells, columns), cells, columns)
        for k, cells in enumerate(frame.iter_rows(named=True), start=1)
    ]
    labels = _labels(header, frame)
    joints = [replace(row, name=name or None) for row, (kind, name) in zip(rows, labels, strict=True) if kind != TIP]
    if len(joints) < 2:
        raise UlnaInputError(f"{header.path}: there are {len(joints)} joints; expected at least two rows. Add them.")
    tips: dict[str, Joint] = {}
    for k, (row, (kind, name)) in enumerate(zip(rows, labels, strict=True), start=1):
        if kind != TIP:
            continue
        if name in tips:
            raise UlnaInputError(
                f"{header.path}: {header.where(k)}, column 'name': got '{name}' again; expected a name of its own for "
                "each tip. Correct it."
            )
        tips[name] = row
    factors = {column.factor for column in columns if column.parameter in LENGTHS}
    return Table(header.path, joints, tips, factors.pop() if len(factors) == 1 else None, _taken(header, columns))


def _taken(header: Header, columns: Sequence[_Column]) -> str:
    """ "theta0 in rad, alpha in rad, a in mm, d in mm", with what an offset means, and what else was read."""
    said = [
        f"{column.parameter} in {column.unit}"
        + (" (turn = sign * encoder + offset)" if column.parameter == "offset" else "")
        for column in columns
    ]
    said += [name for name in (*LABELS, "sign") if name in header.columns]
    return ", ".join(said) + ("" if "sign" in header.columns else "; every encoder's sign is 1")


def _column(name: str, header: Header, length: str | None, angle: str | None) -> _Column:
    match = re.fullmatch(r"([a-z0-9]+?)(?:_(mm|m|in|rad|deg)|\s*[\[(]\s*(mm|m|in|rad|deg|°)\s*[\])])?", name.casefold())
    said = header.units.get(header.own(name), "").strip("[]()")
    parameter = match[1] if match else name
    unit = ((match[2] or match[3]) if match else None) or OWN_ANGLES.unit(said) or OWN_LENGTHS.unit(said)
    unit = "deg" if unit == "°" else unit
    for known, units, option, given in (
        (ANGLES, RAD_PER, "--angle-unit", angle),
        (LENGTHS, MM_PER, "--length-unit", length),
    ):
        if parameter not in known or (unit is not None and unit not in units):
            continue
        if unit is None and given is None:
            raise UlnaInputError(
                f"{header.path}: column '{name}': its unit is not stated and never guessed; expected {option} "
                f"{' or '.join(units)}, or a name such as {name}_{next(iter(units))}. Add one of them."
            )
        if unit is not None and given is not None and unit != given:
            raise UlnaInputError(
                f"{header.path}: column '{name}': its name says {unit}, {option} says {given}; expected the same. "
                "Leave the option out, or rename the column."
            )
        return _Column(name, parameter, units[str(unit or given)])
    if parameter == "theta":
        raise UlnaInputError(
            f"{header.path}: column '{name}': is it an offset (turn = encoder + offset) or a zero offset theta0 (turn "
            "= encoder - theta0)? Expected a column offset or theta0. Rename it; remove it where it is the joint's "
            "variable."
        )
    every = [*ANGLES, *LENGTHS, *LABELS, "sign"]
    close = difflib.get_close_matches(parameter.lower(), every, n=1)
    hint = f" Did you mean '{close[0]}'?" if close else ""
    raise UlnaInputError(
        f"{header.path}: unknown column '{name}'; expected {', '.join(every)}, a unit behind an underscore where it "
        f"has one.{hint} Remove or rename it."
    )


def _check_known(header: Header, known: Sequence[str]) -> None:
    for parameter in known:
        if known.count(parameter) > 1:
            raise UlnaInputError(
                f"{header.path}: the column {parameter} stands twice, in two units; expected it once. Remove one."
            )
    if ("theta0" in known) == ("offset" in known):
        raise UlnaInputError(
            f"{header.path}: there {'are both columns' if 'offset' in known else 'is no column'} theta0 "
            f"{'and' if 'offset' in known else 'or'} offset; expected one of them (offset = -theta0). "
            f"{'Remove one' if 'offset' in known else 'Add it'}."
        )
    for parameter in ("alpha", "a", "d"):
        if parameter not in known:
            raise UlnaInputError(f"{header.path}: the column {parameter} is missing; expected {WHAT}. Add it.")


def _row(header: Header, k: int, cells: dict[str, float], columns: list[_Column]) -> Joint:
    values = {column.parameter: cells[column.name] * column.factor for column in columns}
    for column in columns:
        if column.parameter in ANGLES and abs(values[column.parameter]) > MOST_RAD:
            raise UlnaInputError(
                f"{header.path}: {header.where(k)}, column '{column.name}': got {cells[column.name]:g}, more than two "
                "turns; expected angles within ±4π rad (720°). Are these degrees? State the right unit."
            )
    for column in columns:
        if column.parameter in LENGTHS and not abs(values[column.parameter]) <= MOST_MM:
            raise UlnaInputError(
                f"{header.path}: {header.where(k)}, column '{column.name}': got {cells[column.name]:g}; expected "
                "lengths of at most a kilometre. State the right unit, or correct the cell."
            )
    sign = cells.get("sign", 1.0)
    if sign not in (1.0, -1.0):
        raise UlnaInputError(
            f"{header.path}: {header.where(k)}, column 'sign': got {sign:g}, expected 1 or -1. Correct it."
        )
    beta_rad = values.get("beta", 0.0)
    if beta_rad and values["d"]:
        raise UlnaInputError(
            f"{header.path}: {header.where(k)}: got a beta and a d; expected one of them, for a Hayati joint has no d. "
            "Make one of them 0."
        )
    theta0_rad = values["theta0"] if "theta0" in values else 0.0 - values["offset"]
    model = "hayati" if beta_rad else "dh"
    return Joint(theta0_rad, values["alpha"], values["a"], values["d"], beta_rad, int(sign), model)  # type: ignore[arg-type]


def _typed(header: Header, k: int, row: Joint, cells: dict[str, Any], columns: list[_Column]) -> Joint:
    """With what the column `type` says, and of a prismatic joint how far it slides. Raises UlnaInputError."""
    said = cells.get("type", "rotary")
    if said not in ("rotary", "prismatic", "fixed"):
        raise UlnaInputError(
            f"{header.path}: {header.where(k)}, column 'type': got '{said}', expected rotary, prismatic, or of a tip "
            "fixed. Correct it."
        )
    if said != "prismatic":
        return row
    values = {column.parameter: cells[column.name] * column.factor for column in columns}
    low, high = values.get("lower", math.nan), values.get("upper", math.nan)
    if row.beta_rad or not low < high:
        what = (
            "a prismatic joint has no beta" if row.beta_rad else "lower and upper do not say how far the joint slides"
        )
        raise UlnaInputError(
            f"{header.path}: {header.where(k)}: {what}; expected beta 0, and columns lower and upper with a unit of "
            "length, the lower one first. Correct the row."
        )
    return replace(row, type="prismatic", limits_rad=(low, high))


def _labels(header: Header, frame: pl.DataFrame) -> list[tuple[str, str]]:
    """("joint" or "tip", name) of each row; "" where a joint has no name of its own."""
    kinds = frame["joint"].to_list() if "joint" in frame.columns else [""] * frame.height
    names = frame["name"].to_list() if "name" in frame.columns else [""] * frame.height
    found: list[tuple[str, str]] = []
    for k, (kind, name) in enumerate(zip(kinds, names, strict=True), start=1):
        where = f"{header.path}: {header.where(k)}, column 'joint'"
        if kind == TIP:
            check_name(name or TIP, "name", header.path)
            found.append((TIP, name or TIP))
            continue
        if found and found[-1][0] == TIP:
            raise UlnaInputError(f"{where}: got '{kind}' behind a tip; expected the joints first. Move the row.")
        if re.fullmatch(r"[0-9]+", kind) and int(kind) != k:
            raise UlnaInputError(
                f"{where}: got {kind}, expected {k}: the joints from the base to the probe, one a row. Sort the rows."
            )
        own = "" if kind in ("", str(k)) else kind
        found.append(("joint", own if name in ("", f"joint {k}") else name))
    return found
