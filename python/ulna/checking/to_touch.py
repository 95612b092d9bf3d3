"""What a protocol asks to be touched, and its touches as the table that `ulna check` reads."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.checking.protocol import Protocol
from ulna.checking.result_file import CheckedTable
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.study.readings.columns import ReadingsEntry, Source
from ulna.study.readings.readings import angle_factors
from ulna.verification.kinds.steps import Step
from ulna.verification.own_readings import probe_column, touched_table
from ulna.verification.to_touch import WorkList
from ulna.verification.touches import XYZ

_NOT_WRITTEN = ("sheet", "dataset", "names", "units_row", "fill_down", "comment", "encoding", "thousands")
"""Keys of [readings] that say how others' tables are written, and ours are not."""


def check_written(protocol: Protocol) -> None:
    """Whether touches can be written as its [readings] says. Raises UlnaInputError."""
    given = protocol.file.readings
    lost = [key for key in _NOT_WRITTEN if getattr(given, key) is not None] + (
        [] if given.header is True else ["header"]
    )
    if lost:
        raise UlnaInputError(
            worded(
                "{path}: key 'readings.{key}': says how a table of another program is written; expected none of it "
                "where touches are taken one by one. Take it out, or check from a file.",
                path=str(protocol.path),
                key=lost[0],
            )
        )


def readings_text(
    protocol: Protocol,
    arm: Arm,
    arm_file: Path,
    steps: Sequence[tuple[int, Step]],
    q_rad: F64,
    tip_mm: F64,
    probe: str,
) -> str:
    """A table of touches by their steps, as the protocol says that it is written. Raises UlnaInputError.

    q_rad: (N, n) encoder angles; tip_mm: (N, 3) where the tip of that probe was. A protocol that names an arm has the
    angles, one that names none the points.
    """
    file = protocol.file
    keys = file.readings
    if file.arm is None:
        numbers = dict(zip(XYZ, (tip_mm / file.units.mm).T, strict=True))
    else:
        entry = ReadingsEntry(file="", angle=keys.angle, probe=keys.probe, payload=keys.payload)
        factors = angle_factors(Source(protocol.path, "readings", entry, 0, arm_file), arm, file.units)
        numbers = {f"q{k + 1}": column for k, column in enumerate((q_rad / factors).T)}
    columns = {name: column.tolist() for name, column in numbers.items()}
    table = touched_table(list(steps), columns | probe_column(arm, probe, len(steps)))
    called = keys.columns or {}
    separator = "\t" if keys.separator == "tab" else keys.separator or ","
    decimal = keys.decimal or "."
    if decimal != ".":
        table = table.with_columns(table[name].cast(str).str.replace(".", decimal, literal=True) for name in numbers)
    table = table.rename({ours: theirs for ours, theirs in called.items() if ours in table.columns})
    text = io.StringIO()
    table.write_csv(text, separator=separator)
    return text.getvalue()


def named_as_before(work: WorkList, figures: Sequence[CheckedTable]) -> WorkList:
    """The list with its places and repeats named as in an earlier check, where that has as many: the history of a
    figure is of one name."""
    listed = list(work.listed)
    for test in dict.fromkeys(step.test for step in work.steps):
        own = [k for k, step in enumerate(work.steps) if step.test == test]
        labels = [each.of for each in figures if each.test == test]
        said = list(dict.fromkeys((work.steps[k].position, work.steps[k].repeat) for k in own))
        # a figure of all places together has no label of any
        before = list(dict.fromkeys((each.get("position", ""), each.get("repeat", "")) for each in labels if each))
        names = dict(zip(said, before or [("", "")], strict=False))
        if len(names) != len(said) or len(before) > len(said) or not labels:
            continue
        for k in own:
            step = work.steps[k]
            position, repeat = names[step.position, step.repeat]
            listed[k] = replace(listed[k], step=replace(step, position=position, repeat=repeat))
    return WorkList(work.plan, listed, work.tip_mm)
