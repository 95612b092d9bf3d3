"""`ulna identify`: what readings can and cannot determine."""

from __future__ import annotations

from ulna.cli.options import Json, StudyArgument
from ulna.cli.running import guard


@guard
def identify(study: StudyArgument, as_json: Json = False) -> None:
    """Say what these readings can and cannot determine, without fitting.

    Each lost direction is named as a combination of parameters, with its cause and a remedy. The answer is for the
    start values of the arm and holds nearby.

    Example: [bold]ulna identify study.toml[/bold]
    """
    from ulna.calibration.identify import identify as run_identification
    from ulna.cli import output
    from ulna.cli.printed.identification import identification_report
    from ulna.study.study import Study

    loaded = Study.load(study)
    found = run_identification(loaded)
    if as_json:
        output.print_json({"format": "ulna-identification/1", **found.as_dict()})
    else:
        output.print_renderable(*identification_report(found, loaded.arm))
