"""The columns of a readings file: which there may be, and which value the study gives where one is left out."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import polars as pl
from pydantic import Field

from ulna.artefacts.kinds import KINDS
from ulna.formats.conditions import Condition
from ulna.formats.header import Header
from ulna.formats.layout import TableKeys
from ulna.formats.rows import SplitTable
from ulna.formats.tables.frame import FrameTable
from ulna.formats.tables.heads import is_number
from ulna.formats.unused import remark_strange
from ulna.ground.arrays import I64
from ulna.ground.errors import UlnaInputError, nearest
from ulna.study.readings.conditions import check_conditions, condition_columns, is_number_condition

NAMES = ("id", "probe", "artefact", "placement", "feature")


COORDINATES = ("x", "y", "z", "u")
ROTATIONS = ("rw", "rx", "ry", "rz", "ur")
"""How a target was turned, and how uncertain that is."""

MEASURED = list(dict.fromkeys(kind.measured_column for kind in KINDS.values() if kind.measured_column is not None))
"""Distances that are measured along with a row."""


def is_numeric(column: str) -> bool:
    """Whether a column of a readings file holds numbers; the others hold names."""
    return (
        column in MEASURED
        or column in ROTATIONS
        or is_number_condition(column)
        or re.fullmatch(r"[qp][0-9]+|[xyzu]", column) is not None
    )


def is_length(column: str) -> bool:
    """Whether its numbers are lengths."""
    return column in MEASURED or column in COORDINATES


def known_columns(joints: int, coordinates: bool, turned: bool = False) -> list[str]:
    """The names of all columns that a readings file of an arm may have; x, y, z and u where readings touch points of
    their own, rx, ry, rz and so on where they say how a target was turned."""
    several = [f"{name}{k}" for name in ("q", "p") for k in range(1, joints + 1)]
    own = [*(COORDINATES if coordinates else ()), *(ROTATIONS if turned else ())]
    return [*NAMES, *MEASURED, *several, *condition_columns(joints), *own]


def temperature_columns(header: Header, joints: int) -> list[str]:
    """Those that say how warm it was, of a header that is checked: one, or one for each joint in order, or none."""
    each = ["temperature", *(f"temperature{k}" for k in range(1, joints + 1))]
    return [name for name in each if name in header.columns]


def check_columns(
    header: Header,
    joints: int,
    arm: str,
    remarks: list[str],
    coordinates: bool = False,
    asked: Collection[str] = (),
    turned: bool = False,
) -> list[str]:
    """The encoder columns must fit the arm; a column that is nearly known is an error, any other is remarked upon,
    unless it is one of `asked`, of which the study speaks. Returns the known columns that are there."""
    for letter in ("q", "p") if any(re.fullmatch(r"p[0-9]+", c) for c in header.columns) else ("q",):
        _check_angles(header, letter, joints, arm)
    check_conditions(header, joints, arm)
    known = known_columns(joints, coordinates, turned)
    words = [name for name in known if not name[-1].isdecimal()]
    remark_strange(header, known, words, remarks, asked)
    return [column for column in header.columns if column in known]


def _check_angles(header: Header, letter: str, joints: int, arm: str) -> None:
    expected = [f"{letter}{k}" for k in range(1, joints + 1)]
    there = [column for column in header.columns if re.fullmatch(letter + "[0-9]+", column)]
    missing = [column for column in expected if column not in there]
    extra = [column for column in there if column not in expected]
    if not missing and not extra:
        return
    if header.columns[0].startswith("#"):
        raise UlnaInputError(
            f"{header.path}: {header.head} begins with '#' ({', '.join(header.columns)[:60]}); expected the header "
            f"with {expected[0]} … {expected[-1]}. Remove the comment, or the '#'."
        )
    words = header.columns[0].split()
    if len(header.columns) == 1 and len(words) > 1 and (expected[0] in words or all(map(is_number, words))):
        raise UlnaInputError(
            f"{header.path}: {header.head} is one column, '{header.columns[0][:60]}'; expected {expected[0]} … "
            f'{expected[-1]}. Are the columns separated by blanks? Say separator = " " (--separator " ").'
        )
    slips = [column for column in header.columns if column.lower() in missing]
    origin = next(filter(None, map(header.origin, [*extra, *(c for c in header.columns if c == letter)])), "")
    has = (
        f"{len(there)} column{'s' * (len(there) > 1)} {letter}…"
        if there
        else f"none such ({', '.join(header.columns)[:80]})"
    )
    what = f"the column '{missing[0]}' is missing" if missing else f"the column '{extra[0]}' is one too many"
    raise UlnaInputError(
        f"{header.path}: {what}: the file has {has}, arm '{arm}' has {joints} joints; "
        f"expected {expected[0]} … {expected[-1]}. "
        + (
            f"Rename '{slips[0]}', or map it with the key 'columns'."
            if slips
            else f"{origin}: expected numbers, one row for each reading. Write it so, or name the right arm."
            if origin
            else "Map the file's columns with the key 'columns', name the right arm, or correct the header."
            + header.further
        )
    )


class ReadingsEntry(TableKeys):
    """One readings file. artefact, probe, placement, feature and payload fill the column where the file has none."""

    file: str
    """Path, relative to the study file."""
    angle: Literal["rad", "deg", "counts"] | None = None
    """Unit of the encoder angles; the study's angle unit where it is not given."""
    artefact: str | None = None
    probe: str | None = None
    placement: str | None = None
    feature: str | None = None
    payload: str | None = None
    """What was carried: the name of a [payload] of the study or of the arm file, or "none"."""
    approach: Literal["column", "order"] | None = None
    """What says from which side joints were approached: the columns approach1 … (where the file has them, this need not
    be said), or the order of the rows: the sign of each encoder's last change."""
    ignore: Annotated[list[str], Field(min_length=1)] | None = None
    """Columns that are not used, whatever they are called."""
    where: Annotated[dict[str, Condition], Field(min_length=1)] | None = None
    """Filter: column = what it must hold. A text, a number, a list of these, or `{ above, below, not, empty }`."""
    split: SplitTable | None = None
    """Which rows are fitted and which are kept to check the fit."""


@dataclass(frozen=True)
class Source:
    """Where a readings file stands in its study."""

    study: Path
    key: str
    """`readings.2`: its table in the study."""
    entry: ReadingsEntry
    index: int
    """Into `Study.files`."""
    arm_file: Path
    carried: str | None = None
    """What was carried where neither the file nor its table says it: the study's key `carried`."""
    table: FrameTable | None = None
    """The readings, their columns under their own names, where they are no file."""


def ignored_columns(header: Header, names: Collection[str], key: str) -> list[str]:
    """The columns that are not to be used, as the table calls them. key: how messages call what names them. Raises
    UlnaInputError for one that is not there, or that no study can do without."""
    found = []
    for name in names:
        column = header.find(name)
        if column is None:
            there = [header.own(each) for each in header.columns]
            raise UlnaInputError(
                f"{key}: there is no column '{name}' in {header.path}.{nearest(name, there)} Correct it."
            )
        if re.fullmatch(r"[qp][0-9]+", column):
            raise UlnaInputError(
                f"{key}: {header.named(column)} of {header.path} is an angle of a joint; expected columns that the "
                "study can do without. Take it out of the list."
            )
        found.append(column)
    return found


def codes(
    frame: pl.DataFrame,
    header: Header,
    source: Source,
    column: Literal["artefact", "probe", "feature", "payload"],
    known: list[str],
    owner: str,
    row: I64,
    remarks: list[str] | None = None,
) -> I64 | int:
    """Index into `known` of each row, or one for all rows. Raises UlnaInputError for a name that is not known."""
    given: str | None = getattr(source.entry, column)
    if column in frame.columns:
        if remarks is not None:
            remark_unused(frame, header, source, column, remarks)
        names = frame[column]
        if len(known) == 1:  # nothing needs to be said where there is one choice
            names = names.replace("", known[0])
        strange = ~names.is_in(known)
        if strange.any():
            first = int(strange.arg_true()[0])
            if names[first] == "":
                raise UlnaInputError(header.refusal(int(row[first]), column, is_numeric))
            at = header.at(int(row[first]), column)
            raise UlnaInputError(
                f"{header.path}: {at}: got '{names[first]}', which {owner} does not have."
                f"{nearest(names[first], known)} Correct the cell, or add the {column}."
            )
        return names.replace_strict(known, list(range(len(known))), return_dtype=pl.Int64).to_numpy()
    if given is not None:
        if given not in known:
            raise UlnaInputError(
                f"{source.study}: key '{source.key}.{column}': got '{given}', which {owner} does not have."
                f"{nearest(given, known)} Correct it."
            )
        return known.index(given)
    if len(known) == 1:
        return 0
    raise UlnaInputError(
        f"{header.path}: there is no column '{column}', and {source.study} has no key '{source.key}.{column}'; "
        f"expected one of {', '.join(known[:8])}{', …' if len(known) > 8 else ''} ({owner} has {len(known)}). Add the "
        "column or the key."
    )


def remark_unused(frame: pl.DataFrame, header: Header, source: Source, column: str, remarks: list[str]) -> None:
    """The study's value fills a missing column; where there is one, say that the file's own cells are used."""
    given: str | None = getattr(source.entry, column)
    if given is not None and bool((frame[column] != given).any()):
        key = f"{source.study}: key '{source.key}.{column}'"
        remark = f"{key} = '{given}' is not used: {header.path} has its own column '{column}'."
        if remark not in remarks:
            remarks.append(remark)


def each_row(code: I64 | int, count: int) -> I64:
    """(count,) where one code stands for all rows."""
    return np.full(count, code, dtype=np.int64) if isinstance(code, int) else code
