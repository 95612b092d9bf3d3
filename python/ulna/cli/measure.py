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
        typer.Argument(metavar="READINGS", help="CSV or Parquet with columns q1 … qn.", show_default=False),
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
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Turn encoder readings into points x, y, z in the arm's base frame; any number of rows.

    Columns q1 … qn; id and probe are kept where they are. With a result.json as ARM come the standard uncertainties
    u_x, u_y, u_z, from the calibration and, where its study stated it, the encoders' noise; they are left empty where
    a point depends on what the calibration could not determine, and stderr says why. --json prints one object per
    point, or with -o an account of what was written.

    Example: [bold]ulna measure out/result.json readings.csv -o points.csv[/bold]
    """
    from ulna.cli import output
    from ulna.measure import measure as measure_to_file
    from ulna.measure import measure_to_stream

    choices: Any = {"angle": angle, "units": units}
    if out is None:
        found = measure_to_stream(arm, readings, probe, sys.stdout.buffer, json_lines=as_json, **choices)
    else:
        with output.progress_bar() as progress:
            found = measure_to_file(arm, readings, probe, out, force=force, progress=progress, **choices)
        if as_json:
            output.print_json(found.as_dict())
        output.say(f"Written: {out} ({found.rows} points, {found.unit})")
    for note in found.notes:
        output.say(f"note: {note}")
