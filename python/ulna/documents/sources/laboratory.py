"""The laboratory file: who calibrated what for whom. Of which arm it is, its item says, for people to compare."""

from __future__ import annotations

from pathlib import Path

from ulna.documents.laboratory.file import Laboratory, load_laboratory
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source


def _read(path: Path, _: Calibration) -> tuple[Laboratory, str]:
    found = load_laboratory(path)
    return found, found.sha256


def _remarks(laboratory: Laboratory, path: Path, calibration: Calibration) -> list[Said]:
    """A serial number is no parameter: nothing in a result could contradict it."""
    return []


LABORATORY = Source("laboratory", "ulna-lab", _read, _remarks)
