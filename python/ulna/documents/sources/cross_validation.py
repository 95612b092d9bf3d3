"""A cross-validation: groups of the study's readings, each left out once."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source
from ulna.formats.toml import check_format, read_json

FORMAT = "ulna-cross-validation"


def _read(path: Path, _: Calibration) -> tuple[dict[str, Any], str]:
    document, digest = read_json(path, "a cross-validation.json")
    check_format(document, path, FORMAT)
    return document, digest


def _remarks(document: dict[str, Any], path: Path, calibration: Calibration) -> list[Said]:
    """It names no arm but the files that it was made from: they are those of the result, or it is said."""
    if _digests(document.get("provenance", {})) == _digests(calibration.result.provenance):
        return []
    return [Said("held-out.other-study", {"file": path.name})]


def _digests(made: Mapping[str, Any]) -> list[str]:
    return [file["sha256"] for file in made.get("files", [])]


CROSS_VALIDATION = Source("cross-validation", FORMAT, _read, _remarks)
