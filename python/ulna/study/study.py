"""The study as everybody above uses it: what it is, and the door to its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Self

from ulna.study.data import StudyData
from ulna.study.file import load_study


@dataclass
class Study(StudyData):
    """What to fit to what."""

    @classmethod
    def load(cls, path: str | Path, rows: Literal["fit", "check", "all"] = "fit") -> Self:
        """Read a study file (`ulna-study/1`) and all that it names. Raises UlnaInputError; warns with InputWarning.

        rows: where the study has a split, the rows to fit, the rows kept to check the fit, or both.
        """
        return load_study(Path(path), rows, cls)
