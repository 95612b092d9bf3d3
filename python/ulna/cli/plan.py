"""`ulna plan`: where to put the artefact and which poses to take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import ArmFile, Dask, Force, Json, Keep, OutFolder
from ulna.cli.running import guard


@guard
def plan(
    arm: ArmFile,
    spec: Annotated[Path, typer.Argument(metavar="SPEC", help="The plan file (TOML).", show_default=False)],
    dask: Dask = None,
    keep: Keep = None,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Choose where to put the artefact and which poses to take, before anything is measured.

    Prints what is expected of the calibrated arm beside random choice and beside 101 random measurements, what a
    simulation of it gains, and the observability indices O1 to O5. With -o it writes plan.csv (the list to follow),
    plan.json and pictures. Readings taken already are completed where the file names their study.

    Example: [bold]ulna plan arm.toml plan.toml -o planned[/bold]
    """
    from ulna.arm.arm import Arm
    from ulna.cli import output
    from ulna.cli.printed.plan import plan_report
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.ground.extras import need
    from ulna.planning.file import load_plan_spec
    from ulna.planning.outcome import FILES, NEEDS_PICTURES
    from ulna.planning.plan import plan as run_plan
    from ulna.work.pieces import workers_at

    if out is not None:
        need(NEEDS_PICTURES, "matplotlib")  # before the long work
        check_output(out, FILES, force)
    nominal = Arm.load(arm)
    asked = load_plan_spec(spec, nominal)
    if out is not None:
        refuse_inputs((out / name for name in FILES), [arm, *asked.files])
    with workers_at(dask) as workers, output.progress_bar() as progress:
        found = run_plan(nominal, asked, progress, workers=workers, keep=keep)
    if out is not None:
        found.save(out, force)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*plan_report(found))
    if out is not None:
        output.say(f"Written to {out}: {', '.join(FILES)}")
    elif not as_json:
        output.say("Nothing was written: give -o DIR to keep the plan.")
