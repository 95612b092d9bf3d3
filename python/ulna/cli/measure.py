"""`ulna measure`: encoder readings to points."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from ulna.cli.options import ArmFile, Force, Json
from ulna.cli.running import guard


@guard
def measure(
    arm: ArmFile,
    readings: Annotated[
        Path,
        typer.Argument(metavar="READINGS", help="CSV, Parquet, .xlsx, .mat or HDF5.", show_default=False),
    ],
    probe: Annotated[
        str | None, typer.Option("--probe", metavar="NAME", help="Which probe is on.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="FILE", help="CSV, or Parquet by its ending; without it CSV on stdout."),
    ] = None,
    angle: Annotated[str, typer.Option("--angle", help="Of the readings: rad, deg or counts.")] = "rad",
    units: Annotated[str, typer.Option("--units", help="Of the points: mm, m or in.")] = "mm",
    temperature: Annotated[
        float | None,
        typer.Option("--temperature", metavar="C", help="Of all readings, °C, where they do not say it."),
    ] = None,
    covariance: Annotated[
        bool, typer.Option("--covariance", help="Also c_xy, c_xz, c_yz, beside the diagonal of the covariance.")
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
    temperature needs a column temperature, or --temperature; one whose joints have backlash the columns approach1, ….
    --json prints one object per
    point, or with -o an account of what was written. CSV and Parquet are streamed, other formats are read whole.

    Example: [bold]ulna measure out/result.json readings.csv -o points.csv[/bold]
    """
    from ulna.cli import output
    from ulna.cli.endings import by_ending
    from ulna.formats.layout import Layout
    from ulna.formats.output import refuse_inputs
    from ulna.measuring.measure import measure as measure_to_file
    from ulna.measuring.measure import measure_to_stream

    choices: Any = {"angle": angle, "units": units, "temperature_c": temperature, "covariance": covariance}
    table: Any = {"separator": separator, "decimal": decimal, "sheet": sheet}
    table |= {"thousands": thousands, "encoding": encoding, "comment": comment, "units_row": units_row}
    table |= {"fill_down": tuple(fill_down or ()), "header": (header or True) if not no_header else False}
    layout = Layout.of_options(column, name, dataset=dataset, **table)
    if out is not None:
        refuse_inputs([out], [arm, readings])
        by_ending(out, {".csv": "csv", ".txt": "csv", ".parquet": "parquet", "": "csv"}, [], folder=False)
    if out is None:
        choices["layout"] = layout
        found = measure_to_stream(arm, readings, probe, sys.stdout.buffer, json_lines=as_json, **choices)
    else:
        choices |= {**table, "dataset": dataset, "columns": layout.columns, "names": layout.names}
        with output.progress_bar() as progress:
            found = measure_to_file(arm, readings, probe, out, force=force, progress=progress, **choices)
        if as_json:
            output.print_json(found.as_dict())
        output.say(f"Written: {out} ({found.rows} points, {found.unit})")
    for note in found.notes:
        output.say(f"note: {note}")
