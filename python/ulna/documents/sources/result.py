"""The result of a calibration: what every document is about."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from ulna.arm.file import result_file as result_file
from ulna.calibration.given import ResultLike, as_result
from ulna.calibration.result import Result
from ulna.documents.sources.source import Calibration, ReadFile
from ulna.formats.toml import read_bytes, sha256

IN_MEMORY = Path("result in memory")
"""What documents call a result that was never written."""


def read_calibration(given: ResultLike) -> Calibration:
    """A result, a result.json, or the folder with it. Raises UlnaInputError; TypeError for what is none of them."""
    if isinstance(given, str | os.PathLike):
        file = result_file(Path(given))
        return Calibration(Result.load(file), ReadFile(file, sha256(read_bytes(file, "a result.json"))))
    result = as_result(given)
    known = hashlib.sha256()
    result.write_json(lambda text: known.update(text.encode()))
    return Calibration(result, ReadFile(IN_MEMORY, known.hexdigest()))
