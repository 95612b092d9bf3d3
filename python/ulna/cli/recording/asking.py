"""`ulna record history`, `figures`, `compare`, `due`, `impact`: what the record knows."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

import typer

from ulna.cli.options import All, Json
from ulna.cli.recording.options import Arm, Name, Where, opened
from ulna.cli.running import guard

Since = Annotated[str | None, typer.Option("--since", metavar="DAY", help="When it was last good.")]
Until = Annotated[str | None, typer.Option("--until", metavar="DAY", help="When it was found bad.")]


@guard
def history(name: Name, everything: All = False, where: Where = None, as_json: Json = False) -> None:
    """Say what became of an arm, a robot or an artefact: everything that was done to it, by day.

    The last 30; with --all every one.

    Example: [bold]ulna record history P7[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.records import history_report

    found = opened(where).history(name)
    if as_json:
        output.print_json({"name": name, "history": [asdict(each) for each in found]})
    else:
        output.print_renderable(*history_report(name, found, everything))


@guard
def compare(
    arm: Arm,
    last: Annotated[int, typer.Option("--last", metavar="N", help="So many calibrations, each with the next.")] = 2,
    probe: Annotated[
        str | None, typer.Option("--probe", metavar="NAME", help="With which lengths are compared.")
    ] = None,
    shared_u: Annotated[
        float, typer.Option("--shared-u", metavar="RATIO", help="As of ulna compare: u over length of a bar of both.")
    ] = 0.0,
    everything: All = False,
    where: Where = None,
    as_json: Json = False,
) -> None:
    """Compare the last calibrations of an arm, as ulna compare does. Exit code 1 where it has moved.

    Example: [bold]ulna record compare P7 --last 3[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.comparison import comparison_report

    found = opened(where).compare(arm, last, probe, shared_u)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*comparison_report(found, everything))
    raise typer.Exit(int(any(step.moved for step in found.steps)))


@guard
def due(
    on: Annotated[str | None, typer.Option("--on", metavar="DAY", help="Seen from that day; else today.")] = None,
    where: Where = None,
    as_json: Json = False,
) -> None:
    """Say what must come back, the soonest first. Exit code 1 where something is overdue.

    Example: [bold]ulna record due[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.records import due_report

    found = opened(where).due(on)
    if as_json:
        output.print_json({"due": [asdict(each) for each in found]})
    else:
        output.print_renderable(*due_report(found))
    raise typer.Exit(int(any(each.days is not None and each.days < 0 for each in found)))


@guard
def impact(name: Name, since: Since = None, until: Until = None, where: Where = None, as_json: Json = False) -> None:
    """Say what was done with an arm between the last time that it was found good and the first time that it was found
    bad, and which certificates were issued meanwhile; of an artefact, what rests on it.

    Example: [bold]ulna record impact P7[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.records import impact_report

    found = opened(where).impact(name, since, until)
    if as_json:
        output.print_json(asdict(found))
    else:
        output.print_renderable(*impact_report(found))


COMMANDS = {"history": history, "compare": compare, "due": due, "impact": impact}
