"""A cross-validation: groups of the study's readings, each left out once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ulna.calibration.result_file import CrossValidationFile
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source, json_of

FORMAT = "ulna-cross-validation"


def _remarks(file: CrossValidationFile, path: Path, calibration: Calibration) -> list[Said]:
    """It names no arm but the files that it was made from: they are those of the result, or it is said."""
    files = [] if file.provenance is None else file.provenance.files
    if _digests(files) == _digests(calibration.result.provenance.get("files", [])):
        return []
    return [Said("held-out.other-study", {"file": path.name})]


def _digests(files: Iterable[Mapping[str, Any]]) -> list[str]:
    return [each["sha256"] for each in files]


CROSS_VALIDATION = Source(
    "cross-validation", FORMAT, json_of(FORMAT, "a cross-validation.json", CrossValidationFile), _remarks
)
