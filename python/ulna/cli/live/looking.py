"""`ulna live ports`, `guess`, `watch`: what there is, and what it sends."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.live.options import Seconds, Source
from ulna.cli.options import Force, Json
from ulna.cli.running import guard


@guard
def ports(as_json: Json = False) -> None:
    """List the serial ports of this machine and what is plugged in, and the other kinds of sources.

    Example: [bold]ulna live ports[/bold]
    """
    from dataclasses import asdict

    from ulna.cli import output
    from ulna.cli.printed.live import ports_report
    from ulna.live.ports import ports as found
    from ulna.live.registry import KINDS

    there = found()
    if as_json:
        kinds = [{"scheme": scheme, "example": kind.example, "what": kind.what} for scheme, kind in KINDS.items()]
        output.print_json({"ports": [asdict(each) for each in there], "kinds": kinds})
    else:
        output.print_renderable(*ports_report(there, KINDS))


@guard
def guess(
    source: Source,
    seconds: Annotated[
        float, typer.Option("--seconds", metavar="S", min=0.1, max=600.0, help="How long to listen.")
    ] = 3.0,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the proposal there, a source file.")
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Show what a source sends, raw, and propose how to read it, with the reason for each.

    Turn every joint a little meanwhile. Nothing is taken as it is guessed: look at the proposal, and put it right.

    Example: [bold]ulna live guess serial:/dev/ttyACM0 -o source.toml[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.live import guess_report
    from ulna.formats.output import write_file
    from ulna.live.guessing import guess as guessed
    from ulna.live.listening import listened
    from ulna.live.source_file import read_source

    stated = read_source(source)
    heard = listened(stated, seconds)
    found = guessed(heard.pieces, heard.messages)
    text = found.toml(stated.file.url) if found.decode else None
    if out is not None and text is not None:
        write_file(out, text, force)
    if as_json:
        fields = [{"name": each.name, "role": each.role, "why": each.why} for each in found.fields]
        document = {"kind": found.kind, "reasons": found.reasons, "fields": fields}
        output.print_json({**document, "decode": found.decode, "map": found.map, "bytes": heard.bytes})
    else:
        output.print_renderable(*guess_report(heard, found, text))
    if out is not None and text is not None:
        output.say(f"{out}: a proposal. Look at it, then: ulna live watch {out}")
    raise typer.Exit(int(text is None))


@guard
def watch(source: Source, seconds: Seconds = None, as_json: Json = False) -> None:
    """Show what a source sends, decoded: each channel, its angle, rate, age and what was wrong.

    On a terminal it is shown in place; elsewhere a line a second. With --json every sample is an object a line.

    Example: [bold]ulna live watch source.toml[/bold]
    """
    from ulna.cli.live.watching import watch as watched

    watched(source, seconds, as_json)


COMMANDS = {"ports": ports, "guess": guess, "watch": watch}
