"""The one door for studies: whatever stands for a study, as the study that it stands for."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path

from ulna.ground.errors import wrong_type
from ulna.study.study import Study


class StandsForStudy(ABC):
    """What has a study, and may be given wherever a study is asked for."""

    @abstractmethod
    def its_study(self) -> Study:
        """The study. Raises UlnaInputError where it has none."""


StudyLike = Study | StandsForStudy | str | os.PathLike[str]
"""A study, what was made with one or of one, or the path of a study file or of the folder with a study.toml."""

EXPECTED = "a study: a Study, a Simulated, or the path of a study file or of the folder with study.toml"


def as_study(given: StudyLike) -> Study:
    """The study. Raises UlnaInputError for a file that cannot be used, TypeError for what stands for no study."""
    if isinstance(given, Study):
        return given
    if isinstance(given, StandsForStudy):
        return given.its_study()
    if not isinstance(given, str | os.PathLike):
        raise wrong_type(given, EXPECTED)
    return Study.load(study_path(given))


def study_path(given: str | os.PathLike[str]) -> Path:
    """Of a folder with one the study.toml in it; any other path as it is."""
    path = Path(given)
    inside = path / "study.toml"
    return inside if path.is_dir() and inside.is_file() else path
