"""`ulna live measure`: where the tip is, ± U, and what touches come to."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.live.options import Seconds, Source
from ulna.cli.options import ArmFile, Force, Json
from ulna.cli.running import guard


@guard
def measure(
    arm: ArmFile,
    source: Source,
    probe: Annotated[
        str | None, typer.Option("--probe", metavar="NAME", help="Which probe is on.", show_default=False)
    ] = None,
    feature: Annotated[
        list[str] | None,
        typer.Option(
            "--feature",
            metavar="WORDS",
            help="What touches become: point, length, ball, circle, plane, distance; or of points: length p1 p2. "
            "Repeat it.",
            show_default=False,
        ),
    ] = None,
    still: Annotated[
        bool, typer.Option("--still", help="Each rest of the tip is a touch, whatever the source file says.")
    ] = False,
    to: Annotated[
        str | None,
        typer.Option("--to", metavar="POINT", help="Show distances to this point (p1, …); else to the last."),
    ] = None,
    inside: Annotated[
        bool, typer.Option("--inside", help="Balls are hollows, circles are holes: touched from within.")
    ] = False,
    temperature: Annotated[
        float | None, typer.Option("--temperature", metavar="C", help="Of the arm, °C, where its links grow with it.")
    ] = None,
    payload: Annotated[
        str | None, typer.Option("--payload", metavar="NAME", help="What is carried, where the arm gives way to it.")
    ] = None,
    encoder_u: Annotated[
        float | None,
        typer.Option("--encoder-u", metavar="RAD", min=1e-9, max=0.1, help="Noise of the encoders, where not known."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the points there: .csv, .xlsx, …")
    ] = None,
    force: Force = False,
    seconds: Seconds = None,
    as_json: Json = False,
) -> None:
    """Show where the tip is, x, y, z ± U (k = 2) of this arm at this place, and take points and features.

    In a terminal space takes a point, n begins a new feature, k changes its kind, u takes the last point back, q ends.
    Elsewhere, and for programs (--json), the arm's button takes them, or a rest of the tip: with --still, or
    trigger.by = "still" in the source file. What depends on what the calibration could not determine has no number but
    a reason.

    Example: [bold]ulna live measure out/result.json source.toml --feature ball -o points.csv[/bold]
    """
    from ulna.cli.live.reading import Reading, show
    from ulna.live.features import Notebook, asked_for
    from ulna.live.figures import Calibrated
    from ulna.live.points import check_points
    from ulna.live.source_file import read_source

    if out is not None:
        stated = read_source(source)
        check_points(out, [arm, Path(source), stated.folder / stated.url.path], force)
    kind, asked = asked_for(feature or [])
    calibrated = Calibrated(
        arm, probe, encoder_u_rad=encoder_u, temperature_c=temperature, payload=payload, inside=inside
    )
    show(Reading(calibrated, Notebook(kind, asked), still, to), source, seconds, as_json, out, force)


COMMANDS = {"measure": measure}
