"""`ulna live record`, `replay`: a stream kept, and played again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.live.options import Seconds, Source
from ulna.cli.options import Force, Json
from ulna.cli.running import guard


@guard
def record(
    source: Source,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="FILE", help="Journal to write.", show_default=False)],
    seconds: Seconds = None,
) -> None:
    """Keep all that a source sends in a journal (ulna-journal/1): every sample to the last bit, and what was wrong.

    It can be ended at any moment, also by the power: what was written stays, and at most the last second is lost.

    Example: [bold]ulna live record source.toml -o run.journal --seconds 60[/bold]
    """
    from ulna.cli import output
    from ulna.cli.live.recorded import Recording
    from ulna.cli.live.watching import show

    with Recording(out) as recording:
        known = show(source, seconds, recording.take)
        recording.end(known)
    output.say(f"{out}: {known.count} samples. Play it again: ulna live replay {out}")


@guard
def replay(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A journal, or a CSV file.", show_default=False)],
    speed: Annotated[
        str, typer.Option("--speed", metavar="SPEED", help="1 is as it came, 10 ten times as fast; or max.")
    ] = "1",
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="CSV", help="Write all samples there, as CSV, at full speed.")
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Play a recording again: what was read and what was wrong, as it came, faster, or as fast as can be.

    Example: [bold]ulna live replay run.journal --speed 10[/bold]
    """
    from urllib.parse import quote

    from ulna.cli import output
    from ulna.cli.live.recorded import write_csv
    from ulna.cli.live.watching import watch

    url = f"file:{quote(str(file))}?speed={quote(speed)}"
    if out is None:
        watch(url, None, as_json)
        return
    count = write_csv(file, out, force)
    if as_json:
        output.print_json({"written": str(out), "samples": count})
    output.say(f"{out}: {count} samples.")


@guard
def relay(
    source: Source,
    to: Annotated[
        str,
        typer.Argument(metavar="TO", help="ws://host:port/?token=…, where a push: source listens.", show_default=False),
    ],
    seconds: Seconds = None,
) -> None:
    """Hand a source on to another machine, where a push: source listens: every sample, as it comes.

    Example: [bold]ulna live relay serial:/dev/ttyACM0 "ws://lab:8765/?token=WORDS"[/bold]
    """
    from ulna.cli.live.recorded import HandingOn
    from ulna.cli.live.watching import show

    with HandingOn(to) as other:
        show(source, seconds, other.take)


COMMANDS = {"record": record, "replay": replay, "relay": relay}
