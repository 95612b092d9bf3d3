"""What `ulna evaluate` prints."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.evaluate import Evaluation
from ulna.cli.printed.coverage import coverage_report
from ulna.cli.printed.figures import overall, per_placement


def evaluation_report(found: Evaluation) -> list[RenderableType]:
    """Per placement, then over all, then whether what is stated of the arm holds."""
    rows = {"fit": " that were fitted", "check": " kept to check the fit"}.get(found.provenance.get("rows", ""), "")
    return [
        Text(f"{found.arm.name}: {found.readings} readings{rows}, the arm unchanged."),
        "",
        *per_placement(found.artefacts, "-o DIR writes all of them to evaluation.json."),
        "",
        overall("Over all readings", found.overall),
        *coverage_report(found.coverage),
        *_unknown(found),
    ]


def _unknown(found: Evaluation) -> list[RenderableType]:
    why = None if found.arm.uncertainty is None else found.arm.uncertainty.why_none
    return [] if why is None else ["", Text(f"No uncertainty is known of this arm, so none is judged: {why.because}.")]
