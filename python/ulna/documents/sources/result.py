"""The result of a calibration: what every document is about."""

from __future__ import annotations

from pathlib import Path

from ulna.calibration.result import Result
from ulna.documents.sources.source import Calibration, ReadFile
from ulna.formats.toml import read_bytes, sha256


def result_file(path: Path) -> Path:
    """The result.json itself where a folder is named."""
    return path / "result.json" if path.is_dir() else path


def read_calibration(path: Path) -> Calibration:
    """A result.json, or the folder with it. Raises UlnaInputError."""
    file = result_file(path)
    found = Result.load(file)
    return Calibration(found, ReadFile(file, sha256(read_bytes(file, "a result.json"))))
