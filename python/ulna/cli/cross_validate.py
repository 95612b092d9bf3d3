"""`ulna cross-validate`: refit with each group left out."""

from __future__ import annotations

from typing import Annotated

import typer

from ulna.cli.options import Force, Json, OutFolder, StudyArgument
from ulna.cli.running import guard


@guard
def cross_validate(
    study: StudyArgument,
    by: Annotated[
        str, typer.Option("--by", metavar="placement|artefact|K", help="What is left out together; K random folds.")
    ] = "placement",
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Judge the calibration on readings that it has not seen: refit with each group of readings left out.

    "before" is the start arm with its probes fitted to the other readings, "after" the arm fitted to them; both are
    judged on what was left out. With -o it writes cross-validation.json. Exit code 1 where a fit did not converge.

    Example: [bold]ulna cross-validate study.toml --by placement -o out[/bold]
    """
    from ulna.calibration.cross_validate import FILES
    from ulna.calibration.cross_validate import cross_validate as run_cross_validate
    from ulna.cli import output
    from ulna.cli.printed.cross_validation import cross_validation_report
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.study.study import Study

    if out is not None:
        check_output(out, FILES, force)
    loaded = Study.load(study)
    if out is not None:
        refuse_inputs((out / name for name in FILES), (file.path for file in loaded.files))
    group: str | int = int(by) if by.isdecimal() else by
    with output.progress_bar() as progress:
        found = run_cross_validate(loaded, group, progress)
    if out is not None:
        found.save(out, force)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*cross_validation_report(found))
    if out is not None:
        output.say(f"Written: {out / FILES[0]}")
    bad = [group.group for group in found.groups if not group.converged]
    if bad:
        output.say(f"The fit did not converge without: {', '.join(bad)}. Do not rely on these figures.")
        raise typer.Exit(1)
