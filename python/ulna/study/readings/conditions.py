"""Columns of a readings file that say what was true at poses beside their angles, and the order of rows as such."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Sequence

import numpy as np
import polars as pl

from ulna.arm.conditions import CONDITIONS, Condition
from ulna.formats.header import Header
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import InputWarning, UlnaInputError

_COLUMN = re.compile(
    "|".join(f"{prefix}{'[0-9]*' if each.of_joints else ''}" for each in CONDITIONS for prefix in each.fields)
)
_TEXTS = {prefix for each in CONDITIONS if each.text for prefix in each.fields}


def is_number_condition(column: str) -> bool:
    """Whether a column says such a thing in numbers."""
    return is_condition(column) and column not in _TEXTS


def is_condition(column: str) -> bool:
    """Whether a column says such a thing: `temperature`, `approach3`."""
    return _COLUMN.fullmatch(column) is not None


def condition_columns(joints: int) -> list[str]:
    """The names of all such columns of an arm."""
    found = [each.name for each in CONDITIONS if each.common]
    each_joint = [prefix for each in CONDITIONS if each.of_joints for prefix in each.fields]
    return found + [f"{prefix}{k}" for prefix in each_joint for k in range(1, joints + 1)]


def check_conditions(header: Header, joints: int, arm: str) -> None:
    """All columns of a condition are there, or none. Raises UlnaInputError."""
    for condition, prefix in _numbers():
        each = [f"{prefix}{k}" for k in range(1, joints + 1)]
        there = [column for column in header.columns if re.fullmatch(f"{prefix}[0-9]+", column)]
        twice = condition.common and prefix in header.columns
        if there and (sorted(there) != sorted(each) or twice):
            one = f"one column {prefix}, or " if condition.common else ""
            raise UlnaInputError(
                f"{header.path}: {header.head}: the {prefix} columns are {', '.join(there)}; expected {one}{prefix}1 … "
                f"{prefix}{joints} for the {joints} joints of arm '{arm}'. Correct the header."
            )


def columns_of(condition: Condition, prefix: str, columns: Sequence[str], joints: int) -> list[str]:
    """Those that say it, of a file's columns: one, or one a joint; none where they do not."""
    if condition.common and prefix in columns:
        return [prefix]
    return [f"{prefix}{k}" for k in range(1, joints + 1)] if f"{prefix}1" in columns else []


def said_of(frame: pl.DataFrame, joints: int, header: Header, row: I64) -> dict[str, F64]:
    """What the columns of numbers say, by the fields of `Readings`: (N,) of one column, (N, n) of one a joint. row:
    (N,) in the file. Raises UlnaInputError for what cannot be."""
    found: dict[str, F64] = {}
    for condition, prefix in _numbers():
        own = columns_of(condition, prefix, frame.columns, joints)
        if own:
            values = np.ascontiguousarray(frame.select(own).to_numpy(), dtype=np.float64)
            check_values(values, own, condition, header, row)
            doubt_values(values, own, condition, header)
            found[condition.fields[prefix]] = values[:, 0] if own == [prefix] else values
    return found


def check_values(values: F64, columns: Sequence[str], condition: Condition, header: Header, row: I64) -> None:
    """(N, columns) of a condition that allows some values only. Raises UlnaInputError for the first other one."""
    strange = condition.strange(values)
    if strange.any():
        k, column = (int(at[0]) for at in np.nonzero(strange))
        raise UlnaInputError(
            f"{header.path}: {header.at(int(row[k]), columns[column])}: got {values[k, column]:g}; expected "
            f"{condition.expected}. {condition.remedy}"
        )


def doubt_values(values: F64, columns: Sequence[str], condition: Condition, header: Header) -> None:
    """Warns with InputWarning where all of them look like another unit's."""
    if condition.doubtful(values):
        heads = columns[0] if len(columns) == 1 else f"{columns[0]} … {columns[-1]}"
        warnings.warn(
            f"{header.path}: {heads}: from {values.min():g} to {values.max():g}. {condition.doubt}",
            InputWarning,
            stacklevel=3,
        )


def approach_by_order(q_rad: F64, p_rad: F64 | None) -> tuple[F64, F64 | None]:
    """From the order of all rows of a file, (N, n) encoder angles, of rows of two poses first q, then p: the sign of
    each encoder's last change. A joint that did not move keeps its side; before its first change nobody knows it."""
    poses = q_rad if p_rad is None else np.stack([q_rad, p_rad], axis=1).reshape(-1, q_rad.shape[1])
    sign = np.sign(np.diff(poses, axis=0, prepend=poses[:1]))
    last = np.maximum.accumulate(np.where(sign != 0.0, np.arange(len(poses))[:, None], 0), axis=0)
    approach: F64 = np.take_along_axis(sign, last, axis=0)
    return (approach, None) if p_rad is None else (approach[::2], approach[1::2])


def _numbers() -> Iterator[tuple[Condition, str]]:
    return ((condition, prefix) for condition in CONDITIONS if not condition.text for prefix in condition.fields)
