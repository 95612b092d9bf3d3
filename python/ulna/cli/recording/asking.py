"""`ulna record history`, `figures`, `compare`, `due`, `impact`: what the record knows."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import All, Force, Json
from ulna.cli.recording.options import Arm, By, Name, Where, opened
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
        output.print_renderable(*history_report(name, found, everything, output.columns()))


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
    picture: Annotated[
        Path | None,
        typer.Option("--picture", metavar="FILE", help="As of ulna compare: PNG, SVG or PDF."),
    ] = None,
    where: Where = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Compare the last calibrations of an arm, as ulna compare does. Exit code 1 where it has moved.

    Where it was adjusted, repaired or given another firmware between two of them, that is said, and they are called as
    found and as left.

    Example: [bold]ulna record compare P7 --last 3[/bold]
    """
    from ulna.cli import output
    from ulna.cli.compare import picture_form, write_picture
    from ulna.cli.printed.comparison import comparison_report

    form = "" if picture is None else picture_form(picture, [], force)
    found = opened(where).compare(arm, last, probe, shared_u)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*comparison_report(found, everything))
    if picture is not None:
        write_picture(picture, found, form, force)
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
        output.print_renderable(*due_report(found, output.columns()))
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
        output.print_renderable(*impact_report(found, output.columns()))


@guard
def trend(
    arm: Arm,
    figure: Annotated[
        str | None,
        typer.Argument(metavar="FIGURE", help="As a result or a test names it; without: which there are."),
    ] = None,
    state: Annotated[str | None, typer.Option("--state", metavar="STATE", help="as-found, after, …")] = None,
    artefact: Annotated[
        str | None, typer.Option("--artefact", metavar="NAME", help="Of which test or artefact.")
    ] = None,
    since: Annotated[str | None, typer.Option("--since", metavar="DAY", help="Figures from that day on.")] = None,
    limit: Annotated[
        float | None, typer.Option("--limit", metavar="MM", help="Of its size; else as the last test states it.")
    ] = None,
    guard_band: Annotated[float, typer.Option("--guard", metavar="MM", help="Taken off the limit.")] = 0.0,
    baseline: Annotated[
        int | None,
        typer.Option("--baseline", metavar="N", help="The first N figures make the chart's limits; else half, to 20."),
    ] = None,
    everything: All = False,
    where: Where = None,
    as_json: Json = False,
) -> None:
    """Say how a figure of an arm goes over time: whether it drifts, when it will meet its limit, whether it is in
    control.

    A straight line with its 95 % prediction, and a chart of the newest figure, and of a weighted average,
    against the first ones. What too few figures do not tell is said to be so. Exit code 1 where it is out of control.

    Example: [bold]ulna record trend P7 length_error_rms_mm --state as-found[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.trends import series_report, trend_document, trend_report

    records = opened(where)
    if figure is None:
        known = records.series(arm)
        if as_json:
            output.print_json({"arm": arm, "series": [asdict(each) for each in known]})
        else:
            output.print_renderable(*series_report(arm, known))
        return
    found = records.trend(
        arm, figure, state=state, artefact=artefact, since=since, limit=limit, guard=guard_band, baseline=baseline
    )
    if as_json:
        output.print_json(trend_document(found))
    else:
        output.print_renderable(*trend_report(found, everything))
    raise typer.Exit(int(found.chart.in_control is False))


@guard
def interval(
    name: Name,
    method: Annotated[
        str | None,
        typer.Option("--method", metavar="METHOD", help="staircase, drift or a3; else all that can be said."),
    ] = None,
    figure: Annotated[str | None, typer.Option("--figure", metavar="NAME", help="Of drift: which figure.")] = None,
    limit: Annotated[float | None, typer.Option("--limit", metavar="MM", help="Of drift: its limit.")] = None,
    guard_band: Annotated[float, typer.Option("--guard", metavar="MM", help="Of drift: taken off the limit.")] = 0.0,
    target: Annotated[
        float, typer.Option("--target", metavar="SHARE", help="Of a3: what share is to be in tolerance.")
    ] = 0.95,
    days: Annotated[
        float | None,
        typer.Option("--set", metavar="DAYS", help="Decide: so many days from the last calibration or test."),
    ] = None,
    why: Annotated[str | None, typer.Option("--why", metavar="TEXT", help="Of the decision; it is kept.")] = None,
    where: Where = None,
    by: By = None,
    as_json: Json = False,
) -> None:
    """Advise when an arm should come back, or decide it with --set. Advice says on how much it rests, or that it is too
    little.

    Example: [bold]ulna record interval P7 --method staircase[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.trends import advice_report
    from ulna.records.advising import METHODS

    records = opened(where, by)
    if days is not None:
        entry = records.interval(name, days, method, why)
        output.say(f"{entry.subject}: due {entry.stated['due_at'][:10]}. Entry {entry.seq}.")
        return
    wanted = [method] if method is not None else [each for each in METHODS if each != "drift" or figure is not None]
    found = [records.advise(name, each, figure=figure, limit=limit, guard=guard_band, target=target) for each in wanted]
    if as_json:
        output.print_json({"name": name, "advice": [asdict(each) for each in found]})
    else:
        output.print_renderable(*advice_report(found))


COMMANDS = {"history": history, "trend": trend, "interval": interval, "compare": compare, "due": due, "impact": impact}
