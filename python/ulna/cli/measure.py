"""`ulna measure`: encoder readings to points."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from ulna.cli.options import ArmFile, Force, Json
from ulna.cli.running import guard

STREAM = Path("-")
"""In place of a file: stdin, stdout."""


@guard
def measure(
    arm: ArmFile,
    readings: Annotated[
        Path,
        typer.Argument(
            metavar="READINGS", help="CSV, Parquet, .xlsx, .mat or HDF5; - for CSV from stdin.", show_default=False
        ),
    ],
    probe: Annotated[
        str | None, typer.Option("--probe", metavar="NAME", help="Which probe is on.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "-o", "--out", metavar="FILE", help=".csv, .tsv, .parquet, .xlsx or .jsonl; without it CSV on stdout."
        ),
    ] = None,
    like: Annotated[
        Path | None,
        typer.Option("--like", metavar="STUDY", help="The readings are written as those of this study file."),
    ] = None,
    like_readings: Annotated[
        int | None,
        typer.Option("--like-readings", metavar="N", help="As which of its readings (1, 2, …), where they differ."),
    ] = None,
    angle: Annotated[
        str | None, typer.Option("--angle", help="Of the readings: rad (usual), deg or counts.", show_default=False)
    ] = None,
    units: Annotated[str, typer.Option("--units", help="Of the points: mm, m or in.")] = "mm",
    temperature: Annotated[
        float | None,
        typer.Option("--temperature", metavar="C", help="Of all readings, °C, where they do not say it."),
    ] = None,
    payload: Annotated[
        str | None,
        typer.Option("--payload", metavar="NAME", help="What was carried, where the readings do not say it."),
    ] = None,
    covariance: Annotated[
        bool, typer.Option("--covariance", help="Also c_xx, c_xy, c_xz, c_yy, c_yz, c_zz: each point's covariance.")
    ] = False,
    separator: Annotated[
        str | None, typer.Option("--separator", metavar="SIGN", help='CSV: between columns; or "tab".')
    ] = None,
    decimal: Annotated[str | None, typer.Option("--decimal", metavar="SIGN", help='CSV: "," or ".".')] = None,
    thousands: Annotated[
        str | None, typer.Option("--thousands", metavar="SIGN", help="CSV: between the thousands of numbers.")
    ] = None,
    encoding: Annotated[
        str | None, typer.Option("--encoding", metavar="NAME", help="CSV: cp1252, gbk, …; else UTF-8.")
    ] = None,
    comment: Annotated[
        str | None, typer.Option("--comment", metavar="SIGN", help="CSV, Excel: rows that begin so are not read.")
    ] = None,
    header: Annotated[
        int | None,
        typer.Option("--header", metavar="LINE", min=1, help="CSV, Excel: which line names the columns, if not found."),
    ] = None,
    units_row: Annotated[
        bool | None,
        typer.Option("--units-row/--no-units-row", help="CSV, Excel: whether units stand below the names."),
    ] = None,
    fill_down: Annotated[
        list[str] | None,
        typer.Option("--fill-down", metavar="COLUMN", help="CSV, Excel: gaps mean the cell above; repeat it."),
    ] = None,
    no_header: Annotated[
        bool, typer.Option("--no-header", help="CSV, Excel: columns are called c1, c2, … in --column.")
    ] = False,
    sheet: Annotated[str | None, typer.Option("--sheet", metavar="NAME", help="Excel: which sheet.")] = None,
    dataset: Annotated[
        str | None, typer.Option("--dataset", metavar="PATH", help="HDF5: group or data set; MAT: struct.")
    ] = None,
    column: Annotated[
        list[str] | None,
        typer.Option(
            "--column", metavar="OURS=THEIRS", help="Ulna's name = the file's; repeat it.", show_default=False
        ),
    ] = None,
    name: Annotated[
        list[str] | None,
        typer.Option("--name", metavar="COLUMN.OURS=THEIRS", help="Ulna's name = what stands in the cells; repeat it."),
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Turn encoder readings into points x, y, z in the arm's base frame; any number of rows.

    Columns q1 … qn; id and probe are kept where they are. With a result.json as ARM come the standard uncertainties
    u_x, u_y, u_z, from the calibration and, where its study stated it, the encoders' noise; they are left empty where
    a point depends on what the calibration could not determine, and stderr says why. An arm whose links grow with
    temperature needs a column temperature, or --temperature; one whose joints have backlash the columns approach1, …;
    one whose joints give way to loads of the calibration's study a column payload, or --payload.
    --json prints one object per
    point, or with -o an account of what was written. CSV, Parquet and HDF5 are streamed, others are read whole. From
    stdin (-) each row is measured and written as it comes.

    Example: [bold]ulna measure out/result.json readings.csv -o points.csv[/bold]
    """
    from ulna.cli import output
    from ulna.formats.layout import Layout
    from ulna.formats.tables.coming import coming_table
    from ulna.ground.errors import UlnaInputError
    from ulna.measuring.job import MeasureJob
    from ulna.measuring.like import like_study
    from ulna.measuring.measure import files_of, measure_to_file, measure_to_stream
    from ulna.measuring.written import writer_of
    from ulna.study.readings.readings import WHAT

    if like is None and like_readings is not None:
        raise UlnaInputError(f"option --like-readings: got {like_readings} without --like; expected it with one.")
    to = None if out is None or out == STREAM else out
    if to is not None:
        writer_of(to)  # told before the work
    table: Any = {"separator": separator, "decimal": decimal, "sheet": sheet, "dataset": dataset}
    table |= {"thousands": thousands, "encoding": encoding, "comment": comment, "units_row": units_row}
    table |= {"fill_down": tuple(fill_down or ())}
    stated = Layout.of_options(column, name, **table, header=False if no_header else header or True)
    as_study = None if like is None else like_study(like, like_readings)
    if as_study is None:
        layout, unused = stated, []
    else:
        keys = {**table, "columns": dict(stated.columns), "names": dict(stated.names)}
        layout = as_study.layout(keys | ({"header": stated.header} if no_header or header else {}))
        unused, angle, probe = as_study.unused, angle or as_study.angle, probe or as_study.probe
        payload = payload or as_study.payload
        for remark in as_study.remarks:
            output.say(f"note: {remark}")
    source = coming_table(sys.stdin.buffer, WHAT, layout) if readings == STREAM else readings
    job = MeasureJob(
        arm,
        source,
        probe,
        angle or "rad",
        units,
        layout=layout,
        temperature_c=temperature,
        payload=payload,
        covariance=covariance,
        unused=unused,
    )
    if to is None:
        found = measure_to_stream(job, sys.stdout.buffer, json_lines=as_json)
    else:
        inputs = [*([] if readings == STREAM else [readings]), *files_of(arm), *([] if like is None else [like])]
        with output.progress_bar() as progress:
            found = measure_to_file(job, to, inputs, force, progress)
        if as_json:
            output.print_json(found.as_dict())
        output.say(f"Written: {to} ({found.rows} points, {found.unit})")
    for note in found.notes:
        output.say(f"note: {note}")
