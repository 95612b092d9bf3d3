"""Measure: encoder readings to points, streaming, any number of rows in bounded memory."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO, Literal, TypedDict, Unpack, overload

import numpy as np
import polars as pl
from numpy.typing import ArrayLike

from ulna.arm.data import Loads
from ulna.arm.file import result_file
from ulna.arm.given import ArmLike, as_arm
from ulna.formats.for_sheets import for_sheets
from ulna.formats.frames import is_frame
from ulna.formats.layout import Layout
from ulna.formats.output import new_file, refuse_inputs
from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError, wrong_type
from ulna.measuring.arrays import measure_array, measure_frame
from ulna.measuring.job import MeasureJob
from ulna.measuring.measured import Measured
from ulna.measuring.measurement import Measurement
from ulna.measuring.written import TooManyRowsError, check_room, writer_of

Angle = Literal["rad", "deg", "counts"]


class How(TypedDict, total=False):
    """What else may be said; see `measure`."""

    angle: Angle
    units: Literal["mm", "m", "in"]
    encoder_u_rad: ArrayLike | None
    separator: str | None
    decimal: str | None
    thousands: str | None
    encoding: str | None
    comment: str | None
    header: bool | int
    units_row: bool | None
    fill_down: Sequence[str]
    sheet: str | None
    dataset: str | None
    columns: Mapping[str, str] | None
    names: Mapping[str, Mapping[str, str | Sequence[str]]] | None
    temperature_c: ArrayLike | None
    approach: ArrayLike | None
    payload: Loads
    covariance: bool
    force: bool
    progress: Progress | None


@overload
def measure(
    arm: ArmLike,
    readings: str | os.PathLike[str],
    probe: str | None = None,
    out: str | Path | None = None,
    **how: Unpack[How],
) -> Measurement: ...
@overload
def measure(
    arm: ArmLike, readings: Any, probe: str | Sequence[str] | None = None, out: None = None, **how: Unpack[How]
) -> Measured: ...


def measure(
    arm: ArmLike,
    readings: Any,
    probe: str | Sequence[str] | None = None,
    out: str | Path | None = None,
    *,
    angle: Angle = "rad",
    units: Literal["mm", "m", "in"] = "mm",
    encoder_u_rad: ArrayLike | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    thousands: str | None = None,
    encoding: str | None = None,
    comment: str | None = None,
    header: bool | int = True,
    units_row: bool | None = None,
    fill_down: Sequence[str] = (),
    sheet: str | None = None,
    dataset: str | None = None,
    columns: Mapping[str, str] | None = None,
    names: Mapping[str, Mapping[str, str | Sequence[str]]] | None = None,
    temperature_c: ArrayLike | None = None,
    approach: ArrayLike | None = None,
    payload: Loads = None,
    covariance: bool = False,
    force: bool = False,
    progress: Progress | None = None,
) -> Measurement | Measured:
    """Tip positions of encoder readings.

    `arm`: an arm, a result, or a path of one. With a result come standard uncertainties: of the calibration, and of
    the readings, as they scattered in the calibration: encoders where the study stated their noise (or `encoder_u_rad`,
    one number or (n,), does), touches as stated or as the residuals show, and what the model does not explain.
    `readings`: an array (N, n) of encoder angles, or a table in memory with columns ``q1 … qn`` (optional ``id``,
    ``probe``): gives `Measured`, whose points know their covariances. Or the path of such a table (CSV, Parquet, .xlsx,
    .mat, HDF5), of any number of rows: gives `Measurement`, a table or a file.
    `probe`: which is on; of an array also one name a row. `angle`: of the readings; `units`: of the points of a file.
    `separator`, `decimal`, `thousands`, `encoding`, `comment`, `header`, `units_row`, `fill_down`, `sheet`, `dataset`,
    `columns`, `names`: how the table is written, as in a study's ``[[readings]]``.
    `temperature_c`: of all readings, °C, where the arm's links grow with it and no column ``temperature`` has it; of an
    array also (N,) or (N, n). `approach`: of an array, (N, n), as `Arm.tip` has it. `payload`: what was carried, the
    name of one of the arm's or "none", where no column ``payload`` has it; of an array as `Arm.tip` has it.
    `covariance`: of a file, with a result, also the columns ``c_xx, c_xy, c_xz, c_yy, c_yz, c_zz`` of each point's
    covariance matrix, in the square of the unit.
    `out`: of a file, where to write: .csv, .tsv, .parquet, .xlsx or .jsonl, whole or not at all; None: in memory.
    Raises UlnaInputError naming the first bad cell, ValueError for an array of another shape, TypeError for what can be
    no readings; KeyboardInterrupt leaves nothing behind.
    """
    layout = Layout.of_options(
        columns,
        names,
        separator=separator,
        decimal=decimal,
        thousands=thousands,
        encoding=encoding,
        comment=comment,
        header=header,
        units_row=units_row,
        fill_down=tuple(fill_down),
        sheet=sheet,
        dataset=dataset,
    )
    u_rad = each_encoder(arm, encoder_u_rad)
    if not isinstance(readings, str | os.PathLike):
        _check_in_memory(out, units)
        if is_frame(readings):
            alike = one_number(temperature_c), one_load(payload)
            return measure_frame(arm, readings, layout, one_probe(probe), angle, u_rad, *alike)
        return measure_array(arm, readings, probe, angle, u_rad, temperature_c, approach, payload)
    path = None if out is None else Path(out)
    if path is not None:
        writer_of(path)  # an ending that cannot be written is told before the work
    given = (one_probe(probe), angle, units, u_rad, layout, one_number(temperature_c), covariance)
    job = MeasureJob(arm, Path(readings), *given, payload=one_load(payload))
    if path is None:
        table = pl.concat(list(job.frames(progress)))
        return Measurement(job.rows, job.columns, job.unit, None, table, job.notes)
    return measure_to_file(job, path, [Path(readings), *files_of(arm)], force, progress)


def measure_to_file(
    job: MeasureJob, path: Path, inputs: Sequence[Path], force: bool = False, progress: Progress | None = None
) -> Measurement:
    """The points in a file by its ending, whole or not at all. Raises UlnaInputError; KeyboardInterrupt."""
    write = writer_of(path)
    refuse_inputs([path], inputs)
    check_room(path, job.header.counted)
    with new_file(path, force=force) as staged:
        try:
            write(job.frames(progress), staged)
        except TooManyRowsError as error:
            raise UlnaInputError(f"{path}: {error}") from None
    return Measurement(job.rows, job.columns, job.unit, path, None, job.notes)


def measure_to_stream(job: MeasureJob, file: BinaryIO, json_lines: bool = False) -> Measurement:
    """The points as CSV (or one JSON object a line) to an open file, such as stdout.

    What went out cannot be taken back, so all readings of a file are checked before the first point is written. A table
    that comes as it is made, from a pipe, cannot be: each piece of it is measured, written and flushed as it comes.
    """
    if not job.coming:
        job.check()
    for number, frame in enumerate(job.frames()):
        # as text, so that a reader who has gone away is noticed as Python notices it
        text = frame.write_ndjson() if json_lines else for_sheets(frame).write_csv(include_header=number == 0)
        file.write(text.encode())
        if job.coming:
            file.flush()
    file.flush()
    return Measurement(job.rows, job.columns, job.unit, notes=job.notes)


def files_of(arm: ArmLike) -> list[Path]:
    """Those that an arm is read from."""
    return [result_file(Path(arm))] if isinstance(arm, str | os.PathLike) else []


def each_encoder(arm: ArmLike, encoder_u_rad: ArrayLike | None) -> F64 | None:
    """(n,) of one number for all, or of one each. Raises ValueError for another shape, or what is no deviation."""
    if encoder_u_rad is None:
        return None
    joints = as_arm(arm).n
    each = np.asarray(encoder_u_rad, dtype=np.float64)
    if each.shape not in ((), (joints,)) or not (np.isfinite(each) & (each >= 0.0)).all():
        raise ValueError(f"encoder_u_rad: expected standard deviations, one or ({joints},), got {encoder_u_rad}")
    return np.array(np.broadcast_to(each, (joints,)))


def _check_in_memory(out: object, units: str) -> None:
    """What is said of files alone. Raises UlnaInputError."""
    if out is not None:
        raise UlnaInputError(
            f"measure: out = '{out}', but the readings are in memory; expected a file of readings. Leave it out, and "
            "write .to_polars() of what is measured."
        )
    if units != "mm":
        raise UlnaInputError(f"measure: units = '{units}', but points in memory are in mm. Leave it out.")


def one_probe(probe: str | Sequence[str] | None) -> str | None:
    """Of a table: rows have their own in its column. Raises TypeError for several."""
    if probe is None or isinstance(probe, str):
        return probe
    raise wrong_type(probe, "one probe's name: of a table, each row's stands in the column 'probe'")


def one_number(temperature_c: ArrayLike | None) -> float | None:
    """Of a table: rows have their own in its columns. Raises TypeError for several."""
    if temperature_c is None or np.ndim(temperature_c) == 0:
        return None if temperature_c is None else float(np.asarray(temperature_c))
    raise wrong_type(temperature_c, "one temperature_c: of a table, each row's stands in the column 'temperature'")


def one_load(payload: Loads) -> str | None:
    """Of a table: rows have their own in its column. Raises TypeError for several, and for numbers."""
    if payload is None or isinstance(payload, str):
        return payload
    raise wrong_type(payload, "one payload's name: of a table, each row's stands in the column 'payload'")
