"""Task files: `ulna-task/1`, TOML: a measurement whose uncertainty is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import APPROACH, PAYLOAD, TEMPERATURE
from ulna.formats.layout import Layout, TableKeys
from ulna.formats.models import Strict, fill
from ulna.formats.numbers import Coverage, Uncertainty
from ulna.formats.table import read_header, read_table
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.study.data import Noise
from ulna.study.file import noise_of_table
from ulna.study.readings.checks import check_scale, remark_limits
from ulna.study.readings.columns import ReadingsEntry, Source, check_columns, codes, each_row, is_numeric, known_columns
from ulna.study.readings.conditions import said_of
from ulna.study.readings.payloads import carried_in
from ulna.study.readings.readings import WHAT as WHAT_READINGS
from ulna.study.readings.readings import angle_factors, angles
from ulna.study.tables import NoiseTable
from ulna.uncertainties.measurands import MEASURANDS

WHAT = 'a task file (TOML, format = "ulna-task/1")'


class TaskReadings(TableKeys):
    """The poses."""

    file: str
    """Path, relative to the task file: columns q1 … qn, and feature where there are several."""
    angle: Literal["rad", "deg", "counts"] | None = None
    """Unit of the encoder angles; the task's angle unit where it is not given."""
    probe: str | None = None
    """Which probe is on, where the arm has several."""
    feature: str | None = None
    """What was touched, where the file does not say it."""
    payload: str | None = None
    """What was carried, where the file does not say it: the name of a [payload] of the arm, or "none"."""


class TemperatureTable(Strict):
    """How warm the arm's links are, where they grow with it."""

    value: float
    """°C."""
    u: Uncertainty = 0.0
    """Standard uncertainty, K."""


class TaskFile(Strict):
    """A measurement."""

    format: str
    kind: Literal["point", "length", "ball", "sphericity", "circle", "roundness", "plane", "flatness", "distance"]
    """point: coordinates of what is touched; length: between A and B; ball: centre and diameter of what is touched on
    its surface; circle: centre, diameter and normal of a hole or a shaft touched around; plane: normal and distance
    from the origin; sphericity, roundness, flatness: how far the surface is from them; distance: of point from
    plane."""
    units: Units
    readings: TaskReadings
    noise: NoiseTable | None = None
    """In place of what the calibration's study stated."""
    temperature: TemperatureTable | None = None
    inside: bool = False
    """ball and circle only: a hollow, a hole, touched from within."""
    p: Coverage = 0.95
    """Coverage probability."""
    digits: Literal[1, 2] = 2
    """Significant digits of the uncertainty that a Monte Carlo calculation must settle."""


@dataclass(frozen=True)
class StatedTask:
    """The same in rad and mm, the readings read."""

    path: Path
    file: TaskFile
    q_rad: F64
    """(N, n)"""
    probe: int
    feature: I64
    """(N,) index into the features of the kind."""
    noise: Noise | None
    approach: F64 | None = None
    """(N, n) where the file says it."""
    payload: F64 | None = None
    """(N, 4) what was carried, where it is said: kg and mm."""


def check_temperature(table: TemperatureTable | None, arm: Arm, path: Path) -> None:
    """Raises UlnaInputError where the arm's tip depends on its temperature and none is stated."""
    effect = arm.needs.get(TEMPERATURE)
    if effect is not None and table is None:
        raise UlnaInputError(
            f"{path}: [temperature] is missing, but the {effect.whose} of arm '{arm.name}' {effect.does}; expected "
            "value (°C) and u (K). Add it."
        )


def read_task(path: Path, arm: Arm, features: dict[str, list[str]], remarks: list[str]) -> StatedTask:
    """A task file and its readings; features: of each kind. Raises UlnaInputError."""
    document, _ = read_toml(path, WHAT)
    check_format(document, path, "ulna-task")
    file = fill(TaskFile, document, path)
    if file.inside and MEASURANDS[file.kind].diameter is None:
        round_ones = " or ".join(f'"{kind}"' for kind, each in MEASURANDS.items() if each.diameter is not None)
        raise UlnaInputError(
            f"{path}: key 'inside': a {file.kind} has no inside; expected it with kind = {round_ones}. Remove it."
        )
    check_temperature(file.temperature, arm, path)
    source_file = path.parent / file.readings.file
    entry = ReadingsEntry(
        file=file.readings.file,
        angle=file.readings.angle,
        probe=file.readings.probe,
        feature=file.readings.feature,
        payload=file.readings.payload,
    )
    source = Source(path, "readings", entry, 0, path)
    layout = Layout.of(file.readings, (f"{path}: key 'readings.", "'"), "[readings]")
    header = read_header(source_file, WHAT_READINGS, layout, known_columns(arm.n, False))
    needed = check_columns(header, arm.n, arm.name, remarks)
    frame = read_table(header, is_numeric, needed)
    if not len(frame):
        raise UlnaInputError(f"{source_file}: there are no rows; expected at least one reading. Add them.")
    row = np.arange(1, len(frame) + 1)
    factors = angle_factors(source, arm, file.units)
    q_rad = angles(frame, "q", factors)
    check_scale(q_rad, "q", arm, factors, file.readings.angle or file.units.angle, header, row)
    remark_limits(q_rad, row, "q", arm, source_file, remarks)
    probe = np.unique(
        each_row(codes(frame, header, source, "probe", list(arm.probes), f"arm '{arm.name}'", row), len(row))
    )
    if len(probe) > 1:
        raise UlnaInputError(
            f"{source_file}: {len(probe)} probes in one measurement; expected one. Measure with one, or write a task "
            "for each."
        )
    feature = codes(frame, header, source, "feature", features[file.kind], f"a {file.kind}", row)
    noise = noise_of_table(file.noise, file.units, arm, path)
    said = said_of(frame, arm.n, header, row) | carried_in(frame, header, source, arm, row)
    for condition, effect in arm.needs.items():
        if condition is not TEMPERATURE and condition.said not in said:
            raise UlnaInputError(
                f"{source_file}: the {effect.whose} of arm '{arm.name}' {effect.does}, but the readings "
                f"{condition.unsaid}; expected {condition.columns}. Add it."
            )
    of = said.get(APPROACH.said), said.get(PAYLOAD.said)
    return StatedTask(path, file, q_rad, int(probe[0]), each_row(feature, len(row)), noise, *of)
