"""What `ulna evaluate` prints."""

from __future__ import annotations

from pathlib import Path

from rich.console import RenderableType
from rich.text import Text

from ulna.arm.file import WHAT, result_file
from ulna.calibration.evaluate import Evaluation
from ulna.cli.printed.coverage import coverage_report
from ulna.cli.printed.figures import overall, per_placement
from ulna.formats.toml import read_json

_FLATTER = Text(
    "The arm was calibrated by these readings: they flatter. Judge it by others, or by ulna cross-validate.",
    style="bold yellow",
)


def were_fitted(arm: Path, found: Evaluation) -> bool:
    """Whether the readings are those that a result was made from; False of an arm file, and of rows kept to check."""
    path = result_file(arm)
    if path.suffix.lower() != ".json" or found.provenance.get("rows") == "check":
        return False
    document, _ = read_json(path, WHAT)
    made = document.get("provenance", {}).get("files", [])
    fitted = {file.get("sha256") for file in made if file.get("rows", 0)}
    return any(file["sha256"] in fitted for file in found.provenance["files"] if file["rows"])


def evaluation_report(found: Evaluation, fitted: bool = False) -> list[RenderableType]:
    """Per placement, then over all, then whether what is stated of the arm holds; fitted: the arm was fitted to these
    readings."""
    rows = {"fit": " that were fitted", "check": " kept to check the fit"}.get(found.provenance.get("rows", ""), "")
    return [
        Text(f"{found.arm.name}: {found.readings} readings{rows}, the arm unchanged."),
        "",
        *per_placement(found.artefacts, "-o DIR writes all of them to evaluation.json."),
        "",
        overall("Over all readings", found.overall),
        *(["", _FLATTER] if fitted else coverage_report(found.coverage)),
        *_unknown(found),
    ]


def _unknown(found: Evaluation) -> list[RenderableType]:
    why = None if found.arm.uncertainty is None else found.arm.uncertainty.why_none
    return [] if why is None else ["", Text(f"No uncertainty is known of this arm, so none is judged: {why.because}.")]
