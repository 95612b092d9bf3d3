"""What is known of an arm before something is measured with it: its parameters' uncertainty, and how readings err."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.covariance_file import noise_of_result, seat_of_result
from ulna.arm.file import result_file
from ulna.arm.given import ArmLike, as_arm
from ulna.calibration.given import ResultLike, as_result
from ulna.calibration.result import Result
from ulna.formats.toml import check_format, read_json
from ulna.ground.arrays import F64, Progress
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
    encoder_rad: F64 | None
    """(n,) standard deviation of each encoder; None: nobody stated it."""
    seat_mm: float | None
    """Of a touch, per coordinate; None: nobody stated it."""
    degrees_of_freedom: float
    """Of the parameters' covariance: finite where the calibration estimated the noise from its own residuals."""
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

    def noise(self, stated: Noise | None) -> tuple[F64 | None, float | None]:
        """encoder_rad and seat_mm of a measurement: as stated of it, else as known."""
        if stated is None:
            return self.encoder_rad, self.seat_mm
        encoder_rad = self.encoder_rad if stated.encoder_rad is None else stated.encoder_rad
        return encoder_rad, self.seat_mm if stated.seat_mm is None else stated.seat_mm


def known_of_result(given: ResultLike) -> Known:
    """From a result, a result.json, or the folder of one. Raises UlnaInputError."""
    if not isinstance(given, str | os.PathLike):
        return _known_in_memory(as_result(given))
    result = result_file(Path(given))
    document, _ = read_json(result, WHAT)
    check_format(document, result, "ulna-result")
    arm = Arm.of_result(document, result)
    made = document.get("provenance", {})
    return Known(
        arm=arm,
        encoder_rad=noise_of_result(document, arm, result),
        seat_mm=seat_of_result(document, result),
        degrees_of_freedom=math.inf if made.get("noise") else float(document["fit"]["degrees_of_freedom"]),
        made=made,
    )


def _known_in_memory(result: Result) -> Known:
    made = result.provenance
    return Known(
        arm=result.arm,
        encoder_rad=result.encoder_u_rad,
        seat_mm=seat_of_result({"provenance": made}, Path(label_of(result))),
        degrees_of_freedom=math.inf if made.get("noise") else float(result.fit.degrees_of_freedom),
        made=made,
    )


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
    noise = stated.performance
    return Known(replace(arm, uncertainty=known), noise.encoder_rad, noise.seat_mm or None, math.inf, arms=arms)
