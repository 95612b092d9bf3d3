"""`ulna identify`: what readings can and cannot determine."""

from __future__ import annotations

from ulna.cli.options import Json, Study
from ulna.cli.running import guard


@guard
def identify(study: Study, as_json: Json = False) -> None:
    """Say what these readings can and cannot determine, without fitting.

    Each lost direction is named as a combination of parameters, with its cause and a remedy. The answer is for the
    start values of the arm and holds nearby.

    Example: [bold]ulna identify study.toml[/bold]
    """
    import ulna
    from ulna.cli import output
    from ulna.cli.printed.identification import identification_report

    loaded = ulna.Study.load(study)
    found = ulna.identify(loaded)
    if as_json:
        output.print_json({"format": "ulna-identification/1", **found.as_dict()})
    else:
        output.print_renderable(*identification_report(found, loaded.arm))
