"""What readings say of what was carried: a name in each row, or of a whole file, as numbers."""

from __future__ import annotations

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.conditions import PAYLOAD
from ulna.arm.payload import NOTHING_CARRIED
from ulna.formats.header import Header
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError, nearest
from ulna.study.readings.columns import Source, codes, each_row


def carried_in(
    frame: pl.DataFrame, header: Header, source: Source, arm: Arm, row: I64, remarks: list[str] | None = None
) -> dict[str, F64]:
    """The field `payload` of `Readings`, (N, 4) kg and mm; nothing where nobody says what was carried. row: (N,) in the
    file. Raises UlnaInputError for a name that is not known."""
    column = PAYLOAD.name
    names = [*arm.payloads, NOTHING_CARRIED]
    table = np.array([arm.load_named(name) for name in names])
    if column in frame.columns and not arm.payloads and bool((frame[column] != NOTHING_CARRIED).any()):
        first = int((frame[column] != NOTHING_CARRIED).arg_true()[0])
        raise UlnaInputError(
            f"{header.path}: {header.at(int(row[first]), column)}: got '{frame[column][first]}', but no load has been "
            f"stated; expected [payload.NAME] with mass and centre in {source.study}, or '{NOTHING_CARRIED}'. State "
            f'it, or leave the column out: ignore = ["{header.own(column)}"].'
        )
    if column in frame.columns or source.entry.payload is not None:
        owner = f"{source.study} with arm '{arm.name}'"
        code = codes(frame, header, source, "payload", names, owner, row, remarks)
        return {PAYLOAD.said: table[each_row(code, len(row))]}
    if source.carried is not None:
        return {PAYLOAD.said: np.tile(arm.load_named(source.carried), (len(row), 1))}
    return {}


def check_carried(carried: str | None, arm: Arm, key: str) -> None:
    """Whether an arm has such a load. key: how messages call what says it. Raises UlnaInputError."""
    names = [*arm.payloads, NOTHING_CARRIED]
    if carried is not None and carried not in names:
        raise UlnaInputError(
            f"{key}: got '{carried}'; expected the name of a [payload], or '{NOTHING_CARRIED}'."
            f"{nearest(carried, names)} Correct it, or state the load."
        )
