"""`ulna live commission`: an arm that nobody has described."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.live.options import Source
from ulna.cli.options import Force, Json, numbers, one_of
from ulna.cli.running import guard

UNITS = ("deg", "rad", "counts")
SIGNS = ("turned", "unknown")
ZEROS = ("posture", "known", "unknown")


@guard
def commission(
    source: Source,
    out: Annotated[
        Path,
        typer.Option(
            "-o", "--out", metavar="FOLDER", help="For source.toml, arm.toml and noise.toml.", show_default=False
        ),
    ],
    joints: Annotated[
        int | None, typer.Option("--joints", metavar="N", min=2, max=32, help="Of the arm; --arm says it too.")
    ] = None,
    arm: Annotated[
        Path | None, typer.Option("--arm", metavar="FILE", help="Its geometry: an arm.toml, a result or a URDF.")
    ] = None,
    reach: Annotated[
        float | None,
        typer.Option("--reach", metavar="MM", min=1.0, help="Without --arm: from base to tip; 1000 to be replaced."),
    ] = None,
    unit: Annotated[
        str | None, typer.Option("--unit", metavar="UNIT", help="deg, rad or counts, where the source does not say.")
    ] = None,
    counts_per_turn: Annotated[
        list[float] | None,
        typer.Option(
            "--counts-per-turn", metavar="N", min=2, help="Where no encoder begins again: once, or for each joint."
        ),
    ] = None,
    signs: Annotated[
        str, typer.Option("--signs", metavar="WORD", help="turned: found by turning; unknown: left to a calibration.")
    ] = "turned",
    zeros: Annotated[
        str | None,
        typer.Option(
            "--zeros",
            metavar="WORD",
            help="posture: from one taken by eye; known: as drawn; unknown: left to a calibration.",
            show_default="posture; of what a device tells known, of --reach unknown",
        ),
    ] = None,
    posture: Annotated[
        str | None,
        typer.Option("--posture", metavar="DEG,…", help="That posture, in encoder angles as drawn. Else one is found."),
    ] = None,
    hold: Annotated[
        float, typer.Option("--hold", metavar="S", min=1.0, max=3600.0, help="How long it is held; 60 shows drift.")
    ] = 4.0,
    wait: Annotated[
        float, typer.Option("--wait", metavar="S", min=1.0, max=3600.0, help="How long a joint is waited for.")
    ] = 30.0,
    yes: Annotated[
        bool, typer.Option("--yes", help="Take what is found without being asked; it is shown all the same.")
    ] = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Find out, arm in hand, which channel is which joint, which way it counts, how far it goes and how it errs.

    Hold it still, then turn one joint after the other, as it is asked for. What is found is shown with its numbers and
    taken when you say so. Zero offsets are known by eye then, from a posture that is said in words.

    Example: [bold]ulna live commission serial:/dev/ttyACM0 --joints 6 -o my-arm[/bold]
    """
    from ulna.cli.live.commissioning import Asked, commissioned

    if unit is not None:
        one_of("--unit", unit, UNITS)
    one_of("--signs", signs, SIGNS)
    if zeros is not None:
        one_of("--zeros", zeros, ZEROS)
    stated = None if posture is None else numbers("--posture", posture)
    counts = tuple(counts_per_turn or ())
    asked = Asked(source, out, joints, arm, reach, unit, counts, signs, zeros, stated, hold, wait, yes, force)
    commissioned(asked, as_json)


COMMANDS = {"commission": commission}
