"""The one door for results: a result, or where it was written."""

from __future__ import annotations

import os

from ulna.calibration.result import Result
from ulna.ground.errors import wrong_type

ResultLike = Result | str | os.PathLike[str]
"""A result, or the path of a result.json or of the folder with it."""


def as_result(given: ResultLike) -> Result:
    """The result. Raises UlnaInputError for a file that cannot be used, TypeError for what stands for no result."""
    if isinstance(given, Result):
        return given
    if not isinstance(given, str | os.PathLike):
        raise wrong_type(given, "a result: a Result, or the path of a result.json or of the folder with it")
    return Result.load(os.fspath(given))
