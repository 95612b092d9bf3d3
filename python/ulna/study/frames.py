"""Studies of readings in memory: `Study.from_frame`. What a table of a file is asked, this one is asked too.

A frame goes the way of a file, from the names of its columns on, so that the same numbers give the same study to the
last digit, and the same messages.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ulna.arm.arm import Arm
from ulna.arm.file import result_file
from ulna.arm.given import ArmLike, as_arm
from ulna.arm.payload import Payload
from ulna.artefacts.readings import InputFile
from ulna.artefacts.tables import Place
from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.models import fill
from ulna.formats.own_units import ANGLES
from ulna.formats.rows import Rows
from ulna.formats.table import file_sha256, named_header
from ulna.formats.tables.frame import FrameTable, frame_table
from ulna.formats.units import Units
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.ground.provided import provided
from ulna.study.data import FitOptions, Noise, StudyData, Taken
from ulna.study.options import with_options
from ulna.study.parameters import check_patterns, remark_vain_payloads
from ulna.study.readings.columns import ReadingsEntry, Source, is_length, known_columns
from ulna.study.readings.gathered import gathered
from ulna.study.readings.readings import WHAT, read_readings
from ulna.study.stated import artefacts_of

LABEL = Path("Study.from_frame")
"""How messages call the study."""
FRAME = "frame"
"""How they call its table."""

AnyStudy = TypeVar("AnyStudy", bound=StudyData)


@dataclass(frozen=True)
class Asked:
    """What `Study.from_frame` is told beside arm, frame and artefacts."""

    angle: str | None = None
    length_unit: str | None = None
    guess: bool = False
    rows: Rows = "fit"
    keys: dict[str, Any] = field(default_factory=dict)
    """Of a table [[readings]], as a study file would say them; without those that nobody gave."""
    encoder_u_rad: ArrayLike | None = None
    seat_u_mm: float | None = None
    payloads: Mapping[str, Payload] = field(default_factory=dict)
    """What the arm carried beside its own masses, by name."""
    fit: dict[str, Any] = field(default_factory=dict)


def study_of_frame(given: ArmLike, frame: Any, artefacts: Any, asked: Asked, make: type[AnyStudy]) -> AnyStudy:
    """As `Study.from_frame` says."""
    arm = as_arm(given)
    arm = replace(arm, payloads={**arm.payloads, **asked.payloads})
    remarks: list[str] = []
    files: list[InputFile] = []
    if isinstance(given, str | os.PathLike):
        arm_file = result_file(Path(given))
        files.append(InputFile(arm_file, file_sha256(arm_file), 0))
    else:
        arm_file = Path(f"arm '{arm.name}'")
    found = artefacts_of(artefacts, asked.length_unit, Place(LABEL, _units(asked.length_unit), remarks, files))
    entry = {"file": FRAME, **asked.keys}
    taken: list[Taken] = []
    if asked.guess:
        table = frame_table(frame, FRAME, Layout())
        keys, taken = provided("columns of a frame")(table, arm, list(found.values()), asked.keys, asked.angle)
        entry |= keys
    layout = Layout.of(fill(ReadingsEntry, entry, LABEL), (f"{LABEL}: key '", "'"), "")
    table = frame_table(frame, FRAME, layout, WHAT)
    table, columns = _with_own_units(table, arm, dict(layout.columns))
    entry |= {"columns": columns} if columns else {}
    header = named_header(table, replace(layout, columns=columns), known_columns(arm.n, True, True))
    _check_angles(header, arm)
    entry["angle"] = entry.get("angle") or asked.angle or _angle(header, arm)
    length_unit = _length_unit(header, asked.length_unit, arm)
    source = Source(LABEL, "frame", fill(ReadingsEntry, entry, LABEL), len(files), arm_file, None, table)
    parts, used = read_readings(source, arm, found, _units(length_unit), remarks, asked.rows)
    files.append(used)
    groups = gathered(parts, LABEL, arm, found, files, remarks, asked.rows)
    noise = _noise(asked, arm)
    split = None if "split" not in entry else asked.rows
    study = make(None, arm, groups, noise, FitOptions(), files, remarks, split, taken)
    study = with_options(study, **asked.fit)
    remark_vain_payloads(study)
    check_patterns(study)
    for remark in remarks:
        warnings.warn(remark, InputWarning, stacklevel=3)
    return study


def _units(length_unit: str | None) -> Units:
    return fill(Units, {"length": length_unit or "mm", "angle": "rad"}, LABEL)


def _with_own_units(table: FrameTable, arm: Arm, columns: dict[str, str]) -> tuple[FrameTable, dict[str, str]]:
    """Columns whose names end in a unit, `q1_deg` or `x_mm`, under Ulna's names, and the table that knows the units."""
    units: dict[str, str] = {}
    known = known_columns(arm.n, True, True)
    for name in table.columns:
        match = re.fullmatch(r"(.+)_(rad|deg|counts|mm|m|in)", name)
        if match is None:
            continue
        stem = next((ours for ours, theirs in columns.items() if theirs == name), match[1].casefold())
        if stem in known and stem not in table.columns and columns.get(stem, name) == name:
            columns[stem], units[name] = name, match[2]
    return table.with_units(units), columns


def _check_angles(header: Header, arm: Arm) -> None:
    """Raises UlnaInputError where no column at all is an angle: some are most likely called otherwise."""
    if not any(re.fullmatch("q[0-9]+", column) for column in header.columns):
        shown = ", ".join(map(header.own, header.columns))
        raise UlnaInputError(
            f"{FRAME}: there are no columns q1 … q{arm.n} ({shown[:80]}); expected the encoder angles of arm "
            f"'{arm.name}'. Say which they are, columns = {{'q1': NAME, …}}, or have them recognised, guess = True."
        )


def _angle(header: Header, arm: Arm) -> str:
    """The unit that the columns' names say. Raises UlnaInputError where they say none, or several."""
    turning = np.flatnonzero(~arm.slides).tolist()
    said = {ANGLES.unit(header.units.get(header.own(f"q{k + 1}"), "")) for k in turning}
    if not turning:
        return "rad"
    if len(said) == 1 and None not in said:
        return str(said.pop())
    words = "is not stated, and never guessed" if said <= {None} else "is not the same in all columns' names"
    raise UlnaInputError(
        f"{LABEL}: the unit of the angles {words}; expected angle = 'rad', 'deg' or 'counts', or a unit in each name, "
        "such as q1_deg or 'q1 [deg]'. State it."
    )


def _length_unit(header: Header, stated: str | None, arm: Arm) -> str | None:
    """The unit of lengths in the frame. Raises UlnaInputError where it has some and nobody says their unit."""
    slid = [f"{letter}{k + 1}" for letter in "qp" for k in np.flatnonzero(arm.slides)]
    there = [column for column in header.columns if is_length(column) or column in slid]
    said = {column: header.units.get(header.own(column), stated) for column in there}
    for column, unit in said.items():
        if unit is None:
            raise UlnaInputError(
                f"{LABEL}: {header.named(column)}: its unit is not stated, and never guessed; expected length_unit = "
                f"'mm', 'm' or 'in', or a name such as {column}_mm. State it."
            )
        if unit != next(iter(said.values())) or stated not in (None, unit):
            others = stated if stated not in (None, unit) else next(iter(said.values()))
            raise UlnaInputError(
                f"{LABEL}: {header.named(column)}: its name says {unit}, but {others} is said of other lengths; "
                "expected one unit. Write all lengths of the frame in one."
            )
    return next(iter(said.values()), stated)


def _noise(asked: Asked, arm: Arm) -> Noise | None:
    if asked.encoder_u_rad is None and asked.seat_u_mm is None:
        return None
    encoder_rad = None
    if asked.encoder_u_rad is not None:
        encoder_rad = np.asarray(asked.encoder_u_rad, dtype=np.float64)
        if encoder_rad.shape not in ((), (arm.n,)):
            raise ValueError(f"encoder_u_rad: expected one number or ({arm.n},), got {encoder_rad.shape}")
        encoder_rad = np.array(np.broadcast_to(encoder_rad, (arm.n,)))
    for name, value in (("encoder_u_rad", encoder_rad), ("seat_u_mm", asked.seat_u_mm)):
        if value is not None and not (np.isfinite(value).all() and np.all(np.asarray(value) > 0.0)):
            raise UlnaInputError(f"{LABEL}: {name}: got {value}, expected standard deviations above 0. Correct it.")
    return Noise(encoder_rad, asked.seat_u_mm)
