"""A cross-validation: groups of the study's readings, each left out once."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source, json_of

FORMAT = "ulna-cross-validation"


def _remarks(document: dict[str, Any], path: Path, calibration: Calibration) -> list[Said]:
    """It names no arm but the files that it was made from: they are those of the result, or it is said."""
    if _digests(document.get("provenance", {})) == _digests(calibration.result.provenance):
        return []
    return [Said("held-out.other-study", {"file": path.name})]


def _digests(made: Mapping[str, Any]) -> list[str]:
    return [file["sha256"] for file in made.get("files", [])]


CROSS_VALIDATION = Source("cross-validation", FORMAT, json_of(FORMAT, "a cross-validation.json"), _remarks)
