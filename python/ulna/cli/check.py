"""`ulna check`: a few touches before work."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, Json
from ulna.cli.recorded import Record, record, recording
from ulna.cli.running import guard


@guard
def check(
    protocol: Annotated[Path, typer.Argument(metavar="PROTOCOL", help="What is touched (TOML).", show_default=False)],
    readings: Annotated[
        Path, typer.Argument(metavar="READINGS", help="The table of touches, in any format.", show_default=False)
    ],
    history: Annotated[
        list[Path] | None,
        typer.Option("--history", metavar="PATH", help="An earlier check, or a folder of them; may be repeated."),
    ] = None,
    date: Annotated[
        str | None, typer.Option("--date", metavar="DATE", help="When it was measured, ISO 8601; default: now.")
    ] = None,
    operator: Annotated[str | None, typer.Option("--operator", metavar="NAME", help="Who measured it.")] = None,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write it as JSON, a history for later ones.")
    ] = None,
    force: Force = False,
    as_json: Json = False,
    to_record: Record = None,
) -> None:
    """Check an arm before work, in three minutes: a seat, a bar, their limits, and what they were before.

    Each figure of each place is compared with its limit and, where earlier checks are named, with its own history:
    limits of a baseline, a weighted average, figures in a row. Where one is out it is said what to try. Exit code 1
    where a limit or the history is broken.

    Example: [bold]ulna check protocol.toml monday.csv --history checks -o checks/monday.json[/bold]
    """
    from ulna.checking.check import check as run_check
    from ulna.checking.protocol import load_protocol
    from ulna.cli import output
    from ulna.cli.printed.check import check_report
    from ulna.formats.output import check_output

    if out is not None:
        check_output(out.parent, [out.name], force)
    kept = recording(to_record, out)
    earlier = [*(history or ()), *([] if kept is None else kept.checks(load_protocol(protocol).file.name))]
    found = run_check(protocol, readings, earlier, date, operator)
    if out is not None:
        found.save(out, force)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*check_report(found))
    if out is not None:
        output.say(f"Written: {out}")
        record(kept, out, {"protocol": protocol, "readings": readings})
    raise typer.Exit(int(found.broken))
