"""The one door for arms: whatever stands for an arm, as the arm that it stands for."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.arm.file import WHAT, result_file
from ulna.arm.reading_noise import UNKNOWN, ReadingNoise, noise_of_document
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import wrong_type


class StandsForArm(ABC):
    """What a calibration made, and may be given wherever an arm is asked for."""

    arm: Arm
    """The calibrated one, its `uncertainty` set."""

    @property
    @abstractmethod
    def noise(self) -> ReadingNoise:
        """How its readings scatter, as far as the calibration knew."""


ArmLike = Arm | StandsForArm | str | os.PathLike[str]
"""An arm, a result, or the path of an arm file, of a result.json or of the folder with one."""

EXPECTED = "an arm: an Arm, a Result, or the path of an arm file, of a result.json or of the folder with it"


def as_arm(given: ArmLike) -> Arm:
    """The arm. Raises UlnaInputError for a file that cannot be used, TypeError for what stands for no arm."""
    return arm_and_noise(given)[0]


def arm_and_noise(given: ArmLike) -> tuple[Arm, ReadingNoise]:
    """The arm; of a result also how its readings scatter. Raises as `as_arm`."""
    if isinstance(given, Arm):
        return given, UNKNOWN
    if isinstance(given, StandsForArm):
        return given.arm, given.noise
    if not isinstance(given, str | os.PathLike):
        raise wrong_type(given, EXPECTED)
    path = result_file(Path(given))
    if path.suffix.lower() != ".json":
        return Arm.load(path), UNKNOWN
    document, _ = read_json(path, WHAT)
    check_format(document, path, "ulna-result")
    arm = Arm.of_result(document, path)
    return arm, noise_of_document(document, arm, path)
