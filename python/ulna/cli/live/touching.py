"""`ulna live touch`: from an arm in the hand to readings and a calibrated arm."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.live.options import Seconds, Source
from ulna.cli.options import Json
from ulna.cli.running import guard


@guard
def touch(
    arm: Annotated[
        Path, typer.Argument(metavar="ARM", help="Where to begin: an arm file, or a result.", show_default=False)
    ],
    plan: Annotated[
        Path,
        typer.Argument(
            metavar="PLAN", help="What is touched, and what for: a plan file, or a study.", show_default=False
        ),
    ],
    source: Source,
    out: Annotated[
        Path,
        typer.Option("-o", "--out", metavar="DIR", help="Folder of the session; an interrupted one goes on."),
    ],
    goal: Annotated[
        float | None, typer.Option("--goal", metavar="U", min=1e-6, help="U (k = 2) of a test length to reach, mm.")
    ] = None,
    length: Annotated[
        float | None, typer.Option("--length", metavar="L", min=1e-3, help="That test length, mm; else the plan's.")
    ] = None,
    artefact: Annotated[
        str | None, typer.Option("--artefact", metavar="NAME", help="Which, of a study with several.")
    ] = None,
    trigger: Annotated[
        str | None, typer.Option("--trigger", metavar="BY", help="key, button or still; else as the source file says.")
    ] = None,
    touches: Annotated[
        int | None, typer.Option("--touches", metavar="N", min=1, help="Ends after so many touches.")
    ] = None,
    held_out: Annotated[
        int | None,
        typer.Option("--held-out", metavar="N", min=1, help="At the goal N fresh places, not fitted, to judge by."),
    ] = None,
    seconds: Seconds = None,
    whole: Annotated[
        bool, typer.Option("--whole-stream", help="Keep all that comes in the journal, not only around touches.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Touch an artefact with the arm in your hand, and see after each touch what is known and where to touch next.

    A touch is taken when the tip rests (or by the space bar, or by the arm's button) and refused with a reason where it
    is of no use. One line says how much is known, what a length would be worth, and about how many touches it takes to
    the goal. Keys: space touches, n: the artefact was moved, w withdraws the last touch, h: what follows is held out,
    to judge by (once more: it is fitted again), t: the angles are right again after a fault, q ends. Without a terminal
    the same words are read as lines: touch, moved, withdraw N REASON, hold-out N, trust, end.

    It leaves DIR/session.journal (each touch is there before its tone), and at the end arm.toml, the readings,
    study.toml and result/, and held-out/, what the arm makes of the touches that were not fitted. After a
    crash the same command goes on. Exit code 1 where the fit did not converge.

    Example: [bold]ulna live touch arm.toml plan.toml source.toml -o evening --goal 0.04[/bold]
    """
    import json

    from ulna.arm.given import as_arm
    from ulna.cli import output
    from ulna.cli.live.at_the_arm import Bench
    from ulna.cli.options import one_of
    from ulna.live.ending import JOURNAL, begin, fresh_places_in, nothing_left, write_result, write_study
    from ulna.live.judging import judge
    from ulna.live.purpose import purpose_of
    from ulna.live.session import Session
    from ulna.live.stream import streaming

    if trigger is not None:
        one_of("--trigger", trigger, ("key", "button", "still"))
    nominal = as_arm(arm)
    purpose = purpose_of(plan, nominal, artefact, length)
    for remark in purpose.remarks:
        output.say(remark)
    with streaming(source) as stream:
        by = trigger or stream.stated.file.trigger.by
        session = Session(
            nominal,
            purpose.spec,
            stream,
            fit=purpose.fit,
            goal_u_mm=None if goal is None else 0.5 * goal,
            by_itself=by == "still",
            keep_all=whole,
        )
        stated = stream.stated.file.model_dump(mode="json", exclude_none=True)
        head = {"source": stated, "arm": nominal.name, "artefact": purpose.spec.artefact.name}
        began = (out / JOURNAL).exists()
        journal, known, cut = begin(out, stream.source.hello, **head)
        with journal, nothing_left(out, lambda: began or bool(session.fit.touches)):
            session.journal = journal
            if cut is not None:
                output.say(cut)
            if known:
                session.go_on(known, fresh_places_in(out / JOURNAL))
                output.say(f"{out}: going on with {len(known)} touches.")
            Bench(session, as_json, touches, seconds, held_out).run()
    if session.fit.fitted is None:
        count = len(session.fit.counting())
        why = session.no_fit or "nothing was touched"
        output.say(
            f"{out}: {count} touches are in its journal, too few for a fit: nothing else was written ({why}). The same "
            "command goes on with them."
        )
        return
    study, left_out = write_study(session.fit, out)
    for line in left_out:
        output.say(line)
    result = write_result(study)
    fresh = judge(result, study, nominal)
    if as_json:
        if fresh is not None:
            print(json.dumps({"held_out": fresh.as_dict()}, ensure_ascii=False, allow_nan=False), flush=True)
    else:
        from ulna.cli.printed.brief import brief_report
        from ulna.cli.printed.fresh import fresh_lines

        output.print_renderable(*brief_report(result, output.columns(), None))
        for line in [] if fresh is None else fresh_lines(fresh):
            output.say(line)
    output.say(f"Written: {study}, its readings and {study.parent / 'result'}")
    if not result.fit.converged:
        output.say(f"The fit did not converge ({result.fit.termination}): do not use these numbers.")
        raise typer.Exit(1)


COMMANDS = {"touch": touch}
