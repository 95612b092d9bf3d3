"""Many calibrations at a glance."""

from __future__ import annotations

from rich.console import RenderableType

from ulna.calibration.batch import Batch
from ulna.cli.printed.tables import heading, listed, table
from ulna.ground.digits import figure_mm

_WORDS = {"converged": "converged", "not-converged": "NOT CONVERGED", "refused": "REFUSED"}


def batch_report(found: Batch) -> list[RenderableType]:
    """One line for each study, then what is wrong with those that were refused."""
    rows = [
        (
            study.name,
            "kept" if study.done_before and study.status == "converged" else _WORDS[study.status],
            str(study.readings or "–"),
            f"{study.determined}/{study.parameters}" if study.parameters else "–",
            "–" if study.rms_mm is None else figure_mm(study.rms_mm),
            "–" if study.chi2_per_dof is None else f"{study.chi2_per_dof:.2f}",
            str(study.outliers) if study.readings else "–",
        )
        for study in found.studies
    ]
    made = table(
        f"{len(found.studies)} studies", ("study", "", "readings", "known", "rms / mm", "chi²/dof", "far off"), rows
    )
    made.columns[1].justify = "left"
    parts: list[RenderableType] = [made]
    refused = [study for study in found.studies if study.message is not None]
    if refused:
        parts += ["", heading("Refused"), listed((study.name, study.message or "") for study in refused)]
    return parts
