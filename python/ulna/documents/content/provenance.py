"""From what, with what and when the result was made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ulna.documents.sources.source import Calibration, ReadFile
from ulna.documents.sources.study import FileRow


@dataclass(frozen=True)
class Provenance:
    """From what, with what and when the result was made."""

    program: str
    version: str
    time: str
    """As the result says it, ISO 8601."""
    seed: int
    study: str | None
    result: str
    """Name of the result file."""
    result_sha256: str
    files: list[FileRow]
    beside: list[ReadFile]
    """Laboratory file, verification, cross-validation, evaluation: those that were given."""
    options: dict[str, Any]
    warnings: list[str]


def provenance(calibration: Calibration, files: Sequence[FileRow], beside: Sequence[ReadFile]) -> Provenance:
    """files: of the result, with their state; beside: what else the document is made from."""
    made = calibration.result.provenance
    return Provenance(
        program=str(made.get("program", "ulna")),
        version=str(made.get("version", "")),
        time=str(made.get("time", "")),
        seed=int(made.get("seed", 0)),
        study=made.get("study"),
        result=calibration.file.name,
        result_sha256=calibration.file.sha256,
        files=list(files),
        beside=list(beside),
        options=dict(made.get("options", {})),
        warnings=[str(text) for text in made.get("warnings", [])],
    )
