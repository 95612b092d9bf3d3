"""Arms from what others drew, in memory: `Arm.from_urdf`, `Arm.from_dh`. Commands write files instead."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.modified import Convention
from ulna.exchange.importers.dh import arm_from_table
from ulna.exchange.importers.dh_table import WHAT, dh_of, read_dh
from ulna.exchange.importers.urdf import base_remark
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain
from ulna.exchange.urdf.units import in_units
from ulna.formats.frames import is_frame
from ulna.formats.layout import AS_EXPECTED
from ulna.formats.tables.frame import frame_table
from ulna.formats.units import MM_PER, RAD_PER
from ulna.ground.errors import InputWarning, UlnaInputError, nearest, wrong_type

TABLE = "the DH table"
"""How messages call a table in memory."""
ROW = ("theta0", "d", "a", "alpha")
"""What a row of plain numbers holds."""


def arm_of_urdf(
    path: Path, tip_link: str | None, base_link: str | None, length_unit: str | None, angle_unit: str | None
) -> Arm:
    """As `Arm.from_urdf` says."""
    with _arguments():
        _check_units(length_unit, angle_unit)
        chain = in_units(read_chain(path, tip_link, base_link), length_unit, angle_unit)
        arm, t_root_base = arm_from_chain(chain)
    moved = [] if np.array_equal(t_root_base, np.eye(4)) else [base_remark(t_root_base, f"of '{chain.base_link}'")]
    _remark(str(path), [*chain.remarks, *moved])
    return arm


def arm_of_dh(
    table: Any,
    convention: Convention,
    length_unit: str | None,
    angle_unit: str | None,
    tip: Sequence[float] | None,
    name: str | None,
) -> Arm:
    """As `Arm.from_dh` says."""
    if convention not in ("dh", "modified-dh"):
        raise UlnaInputError(
            f"convention '{convention}'; expected 'dh' or 'modified-dh'.{nearest(convention, ('dh', 'modified-dh'))}"
        )
    point = None if tip is None else tuple(float(value) for value in tip)
    if point is not None and len(point) != 3:
        raise ValueError(f"tip: expected three numbers, got {len(point)}")
    with _arguments():
        _check_units(length_unit, angle_unit)
        if isinstance(table, str | os.PathLike):
            read = read_dh(Path(table), length_unit, angle_unit)
        else:
            read = dh_of(frame_table(_rows(table), TABLE, AS_EXPECTED, WHAT), length_unit, angle_unit)
        found = arm_from_table(read, convention, point)
    _remark(str(read.path), found.remarks)
    own = "arm" if read.path == Path(TABLE) else found.arm.name
    return replace(found.arm, name=name or own)


def _rows(table: Any) -> Any:
    """A list of rows of four numbers as columns; any other table as it is. Raises TypeError for what is no table."""
    if is_frame(table):
        return table
    try:
        rows = np.asarray(table, dtype=np.float64)
    except (TypeError, ValueError):
        rows = np.empty(0)
    if rows.ndim != 2 or rows.shape[1] != len(ROW):
        raise wrong_type(
            table,
            "a DH table: a path, a DataFrame, a dict of arrays, a list of dicts, or rows of four numbers theta0, d, a, "
            "alpha",
        )
    return {name: rows[:, k] for k, name in enumerate(ROW)}


def _check_units(length_unit: str | None, angle_unit: str | None) -> None:
    for argument, given, known in (("length_unit", length_unit, MM_PER), ("angle_unit", angle_unit, RAD_PER)):
        if given is not None and given not in known:
            raise UlnaInputError(
                f"{argument}: got '{given}', expected {' or '.join(map(repr, known))}.{nearest(given, known)}"
            )


@contextmanager
def _arguments() -> Iterator[None]:
    """Messages that name options of a command name arguments here: `--tip-link` is `tip_link`."""
    try:
        yield
    except UlnaInputError as error:
        said = re.sub(r"--([a-z]+(?:-[a-z]+)*)", lambda match: match[1].replace("-", "_"), str(error))
        raise UlnaInputError(said) from None


def _remark(label: str, remarks: Sequence[str]) -> None:
    for remark in remarks:
        warnings.warn(f"{label}: {remark}", InputWarning, stacklevel=4)
