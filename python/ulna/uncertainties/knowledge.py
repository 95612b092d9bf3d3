"""What is known of an arm before something is measured with it: its parameters' uncertainty, and how readings err."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.file import result_file
from ulna.arm.given import ArmLike, as_arm
from ulna.arm.reading_noise import ReadingNoise, noise_of_document
from ulna.calibration.given import ResultLike, as_result
from ulna.formats.toml import check_format, read_json
from ulna.ground.arrays import Progress
from ulna.ground.errors import UlnaInputError
from ulna.simulation.mover import travel_or_limits
from ulna.study.data import Noise
from ulna.uncertainties.constrained import Constrained
from ulna.uncertainties.performance_file import read_performance
from ulna.work.pieces import Workers

FIRST = 5000
"""Arms that agree from which a covariance is formed, for the first order."""

WHAT = "the result.json of a calibration"


@dataclass(frozen=True)
class Known:
    """Of one arm."""

    arm: Arm
    """Its `uncertainty` is set."""
    noise: ReadingNoise
    """How its readings scatter."""
    made: dict[str, Any] = field(default_factory=dict)
    """Provenance of the result."""
    arms: Constrained | None = None
    """Where nothing but a performance test is known: the arms that agree with it."""

    def check_probe(self, probe: str, label: str) -> None:
        """Raises UlnaInputError where nothing is known of a probe: another one was on in the performance test."""
        tested = probe if self.arms is None else self.arms.performance.probe
        if probe != tested:
            raise UlnaInputError(
                f"{label}: probe '{probe}' is on, but {self.arms.performance.label if self.arms else ''} is of probe "
                f"'{tested}'; expected the same, for nothing is known of another one's tip. Measure with '{tested}'."
            )

    def measuring(self, stated: Noise | None) -> ReadingNoise:
        """Of a measurement: as stated of it, else as known."""
        return self.noise if stated is None else self.noise.stated(stated.encoder_rad, stated.seat_mm)


def known_of_result(given: ResultLike) -> Known:
    """From a result, a result.json, or the folder of one. Raises UlnaInputError."""
    if not isinstance(given, str | os.PathLike):
        found = as_result(given)
        return Known(found.arm, found.noise, found.provenance)
    result = result_file(Path(given))
    document, _ = read_json(result, WHAT)
    check_format(document, result, "ulna-result")
    arm = Arm.of_result(document, result)
    return Known(arm, noise_of_document(document, arm, result), document.get("provenance", {}))


def label_of(result: ArmLike) -> str:
    """How messages call a result, or an arm: by its path, or by its arm's name."""
    return str(result) if isinstance(result, str | os.PathLike) else f"arm '{as_arm(result).name}'"


def known_of_performance(
    given: ArmLike, performance: Path, seed: int = 0, workers: Workers | None = None, progress: Progress | None = None
) -> Known:
    """From an arm and a performance file: what a certificate's figures say of the arm. Raises UlnaInputError;
    KeyboardInterrupt."""
    arm = as_arm(given)
    stated = read_performance(performance, arm)
    travel_rad = travel_or_limits(arm, stated.travel_rad, str(performance))
    arms = Constrained(arm, stated.performance, travel_rad, seed, workers, progress)
    sets = arms.sets(0, FIRST)
    moved = np.flatnonzero(np.ptp(sets, axis=0))
    covariance = np.cov(sets[:, moved], rowvar=False)
    known = ParameterCovariance([arm.parameter_names[k] for k in moved], covariance, [])
    noise = ReadingNoise(stated.performance.encoder_rad, stated.performance.seat_mm or None)
    return Known(replace(arm, uncertainty=known), noise, arms=arms)
