"""`ulna live geometry`: the arm as its device itself describes it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.live.options import Source
from ulna.cli.options import Force
from ulna.cli.running import guard


@guard
def geometry(
    source: Source,
    out: Annotated[
        Path, typer.Option("-o", "--out", metavar="FILE", help="The arm file to write.", show_default=False)
    ],
    force: Force = False,
) -> None:
    """Write the geometry that a device tells of itself as an arm file: a MicroScribe has its own table in it.

    It is what its maker measured once: a start for a calibration, and good for looking at it.

    Example: [bold]ulna live geometry microscribe:/dev/ttyUSB0 -o arm.toml[/bold]
    """
    from ulna.cli import output
    from ulna.exchange.importers.urdf import commented
    from ulna.formats.output import refuse_inputs, write_file
    from ulna.ground.errors import UlnaInputError
    from ulna.live.registry import KINDS, device_arm
    from ulna.live.source_file import read_source

    stated = read_source(source)
    refuse_inputs([out], [stated.path])
    drawn = device_arm(stated)
    if drawn is None:
        kinds = ", ".join(f"{scheme}:" for scheme, kind in KINDS.items() if kind.arm)
        raise UlnaInputError(
            f"source '{stated.url.text}': tells no geometry; expected one of {kinds}. Give a drawing where an arm is "
            "asked for, or let ulna live commission guess one."
        )
    write_file(out, commented(drawn.arm, [f"Written by ulna live geometry: {drawn.said}."]), force=force)
    output.say(f"{out}: {drawn.said}.")
    output.say(f"Next: ulna live measure {out} {source}")


COMMANDS = {"geometry": geometry}
