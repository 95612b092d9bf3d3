"""Measure: encoder readings to points, streaming, any number of rows in bounded memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, Literal

import polars as pl

from ulna.arm.arm import Arm
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.output import new_file, refuse_inputs
from ulna.ground.arrays import F64, Progress
from ulna.ground.extras import need
from ulna.measuring.job import MeasureJob

Angle = Literal["rad", "deg", "counts"]


@dataclass
class Measurement:
    """What was measured: a table in memory, or a file."""

    rows: int
    columns: list[str]
    """`id` and `probe` where the readings have them; `x, y, z`; `u_x, u_y, u_z` (standard uncertainties) where the
    arm came from a result; `c_xy, c_xz, c_yz` (covariances) where they were asked for."""
    unit: str
    """Of the coordinates and their uncertainties."""
    path: Path | None = None
    table: pl.DataFrame | None = None
    notes: list[str] = field(default_factory=list)
    """Why uncertainties were left empty, and what to do about it."""

    def as_dict(self) -> dict[str, Any]:
        """JSON types only."""
        return {
            "format": "ulna-measurement/1",
            "rows": self.rows,
            "columns": self.columns,
            "unit": self.unit,
            "out": None if self.path is None else str(self.path),
            "notes": self.notes,
        }


def measure(
    arm: Arm | str | Path,
    readings: str | Path,
    probe: str | None = None,
    out: str | Path | None = None,
    *,
    angle: Angle = "rad",
    units: Literal["mm", "m", "in"] = "mm",
    encoder_u_rad: F64 | None = None,
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
    temperature_c: float | None = None,
    covariance: bool = False,
    force: bool = False,
    progress: Progress | None = None,
) -> Measurement:
    """Tip positions of encoder readings (columns ``q1 … qn``; optional ``id``, ``probe``): a CSV, Parquet, .xlsx, .mat
    or HDF5 file.

    `arm`: an arm, an arm file or a result. With a result come standard uncertainties: of the calibration, and of the
    encoders where the study stated their noise (or `encoder_u_rad`, (n,), does).
    `separator`, `decimal`, `thousands`, `encoding`, `comment`, `header`, `units_row`, `fill_down`, `sheet`, `dataset`,
    `columns`, `names`: how the file is written, as in a study's ``[[readings]]``.
    `temperature_c`: of all readings, °C, where the arm's links grow with it and the file has no column ``temperature``.
    `covariance`: with a result, also the columns ``c_xy, c_xz, c_yz``, what is beside the diagonal of each point's
    covariance matrix, in the square of the unit; the diagonal is u².
    `out`: a CSV or Parquet file (by its ending), written whole or not at all; None: the table is returned in memory.
    Raises UlnaInputError naming the first bad cell; KeyboardInterrupt leaves nothing behind.
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
    job = MeasureJob(arm, Path(readings), probe, angle, units, encoder_u_rad, layout, temperature_c, covariance)
    table = path = None
    if out is None:
        table = pl.concat(list(job.frames(progress)))
    else:
        path = Path(out)
        refuse_inputs([path], [Path(readings), *([] if isinstance(arm, Arm) else [Path(arm)])])
        with new_file(path, force=force) as staged:
            write = _write_parquet if path.suffix.lower() == ".parquet" else _write_csv
            write(job.frames(progress), staged)
    return Measurement(job.rows, job.columns, job.unit, path, table, job.notes)


def measure_to_stream(
    arm: str | Path,
    readings: str | Path,
    probe: str | None,
    file: BinaryIO,
    *,
    json_lines: bool = False,
    angle: Angle = "rad",
    units: Literal["mm", "m", "in"] = "mm",
    layout: Layout = AS_EXPECTED,
    temperature_c: float | None = None,
    covariance: bool = False,
) -> Measurement:
    """The same, written as CSV (or one JSON object a line) to an open file, such as stdout.

    What went out cannot be taken back, so all readings are checked before the first point is written.
    """
    job = MeasureJob(
        arm, Path(readings), probe, angle, units, layout=layout, temperature_c=temperature_c, covariance=covariance
    )
    job.check()
    for number, frame in enumerate(job.frames()):
        # as text, so that a reader who has gone away is noticed as Python notices it
        text = frame.write_ndjson() if json_lines else frame.write_csv(include_header=number == 0)
        file.write(text.encode())
    file.flush()
    return Measurement(job.rows, job.columns, job.unit, notes=job.notes)


def _write_csv(frames: Iterator[pl.DataFrame], path: Path) -> None:
    """Numbers in the shortest form that reads back the same."""
    with path.open("wb") as file:
        for number, frame in enumerate(frames):
            frame.write_csv(file, include_header=number == 0)


def _write_parquet(frames: Iterator[pl.DataFrame], path: Path) -> None:
    need(str(path), "pyarrow")
    import pyarrow.parquet

    with ExitStack() as stack:
        writer: Any = None
        for frame in frames:
            table = frame.to_arrow()
            if writer is None:
                writer = stack.enter_context(pyarrow.parquet.ParquetWriter(path, table.schema, compression="zstd"))
            writer.write_table(table)
