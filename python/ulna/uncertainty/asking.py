"""From a result and a task file to what is known of the measurement."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ulna.errors import InputWarning, UlnaInputError
from ulna.files.arm import arm_of_result
from ulna.files.covariance import noise_of_result, seat_of_result
from ulna.files.task import read_task
from ulna.files.toml import check_format, read_json
from ulna.study import Study
from ulna.uncertainty.assess import Assessment, assess
from ulna.uncertainty.measurands import MEASURANDS, Touched
from ulna.uncertainty.task import Task
from ulna.work.pieces import Workers

WHAT = "the result.json of a calibration"

Progress = Callable[[str, int, int], None]


def uncertainty(
    result: str | Path,
    task: str | Path,
    *,
    study: Study | None = None,
    seed: int = 0,
    most_trials: int = 1_000_000,
    workers: Workers | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """How sure a measurement is: of a calibrated arm (`result.json`, or the folder of one) and a task file.

    study: the study of that calibration, to repeat whole calibrations on new noise; else parameters are drawn from the
    result's covariance. most_trials: of the Monte Carlo calculation; 0: first order alone. Raises UlnaInputError;
    KeyboardInterrupt.
    """
    result, task = Path(result), Path(task)
    result = result / "result.json" if result.is_dir() else result
    document, _ = read_json(result, WHAT)
    check_format(document, result, "ulna-result")
    arm = arm_of_result(document, result)
    made = document.get("provenance", {})
    if study is not None:
        check_same(study, made, result)
    remarks: list[str] = []
    stated = read_task(task, arm, {kind: list(found.features) for kind, found in MEASURANDS.items()}, remarks)
    for remark in remarks:
        warnings.warn(remark, InputWarning, stacklevel=2)
    touched = Touched(stated.file.kind, stated.feature)
    touched.check(str(task))
    encoder_rad, seat_mm = noise_of_result(document, arm, result), seat_of_result(document, result)
    if stated.noise is not None:
        encoder_rad = encoder_rad if stated.noise.encoder_rad is None else stated.noise.encoder_rad
        seat_mm = seat_mm if stated.noise.seat_mm is None else stated.noise.seat_mm
    warm = stated.file.temperature
    return assess(
        arm,
        Task(
            touched=touched,
            q_rad=np.ascontiguousarray(stated.q_rad),
            probe=list(arm.probes)[stated.probe],
            label=str(task),
            encoder_rad=encoder_rad,
            seat_mm=seat_mm,
            temperature_c=None if warm is None else warm.value,
            u_temperature_k=0.0 if warm is None or "link-expansion" not in arm.extras else warm.u,
            inside=stated.file.inside,
            degrees_of_freedom=math.inf if made.get("noise") else float(document["fit"]["degrees_of_freedom"]),
            p=stated.file.p,
            digits=stated.file.digits,
        ),
        study=study,
        seed=seed,
        most_trials=most_trials,
        workers=workers,
        progress=progress,
    )


def check_same(study: Study, made: dict[str, Any], result: Path) -> None:
    """Raises UlnaInputError where the result was not made from this study."""
    theirs = [file.get("sha256") for file in made.get("files", [])]
    if theirs != [file.sha256 for file in study.files]:
        raise UlnaInputError(
            f"{study.label}: {result} was not made from it, or its files have changed since; expected the study of "
            f"that calibration ({made.get('study')}). Name it, or leave --study out."
        )
