"""From a result and a task file to what is known of the measurement."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.conditions import TEMPERATURE
from ulna.arm.given import ArmLike
from ulna.calibration.given import ResultLike
from ulna.calibration.recalibrations import job_of
from ulna.ground.arrays import Progress
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.simulation.mover import travel_or_limits
from ulna.study.given import StudyLike, as_study
from ulna.study.study import Study
from ulna.uncertainties.assess import Assessment, assess
from ulna.uncertainties.knowledge import Known, known_of_performance, known_of_result, label_of
from ulna.uncertainties.measurands import MEASURANDS, Touched
from ulna.uncertainties.task import Task
from ulna.uncertainties.task_file import read_task
from ulna.uncertainties.volume import VolumeMap, VolumeTask, volume_map
from ulna.uncertainties.volume_file import read_volume
from ulna.work.ledger import Ledger
from ulna.work.pieces import Workers


def uncertainty(
    result: ResultLike | ArmLike,
    task: str | Path,
    *,
    study: StudyLike | None = None,
    performance: str | Path | None = None,
    seed: int = 0,
    most_trials: int = 1_000_000,
    workers: Workers | None = None,
    keep: str | Path | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """How sure a measurement is: of a calibrated arm (a result, a `result.json`, or the folder of one) and a task file.

    performance: a performance file, where the calibration is not at hand; then `result` is an arm, or an arm.toml.

    study: the study of that calibration, to repeat whole calibrations on new noise; else parameters are drawn from the
    result's covariance. most_trials: of the Monte Carlo calculation; 0: first order alone. keep: folder for finished
    calibrations, from which the same question goes on. Raises UlnaInputError; KeyboardInterrupt.
    """
    task, label = Path(task), label_of(result)
    study = None if study is None else as_study(study)
    if performance is not None and study is not None:
        raise UlnaInputError(
            f"{performance}: stands for a calibration that is not at hand, but {study.label} is one; expected one of "
            "them. Leave one out."
        )
    known = _known(result, performance, seed, workers, progress)
    arm = known.arm
    ledger = None
    if study is not None:
        check_same(study, known.made, label)
        if keep is not None:
            ledger = Ledger(Path(keep), job_of(study, arm, most_trials, seed))
    elif keep is not None:
        raise UlnaInputError(
            f"{keep}: finished calibrations are to be kept there, but none are made; expected the study that they "
            "repeat. Name it (--study), or keep nothing."
        )
    remarks: list[str] = []
    stated = read_task(task, arm, {kind: list(found.features) for kind, found in MEASURANDS.items()}, remarks)
    for remark in remarks:
        warnings.warn(remark, InputWarning, stacklevel=2)
    probe = list(arm.probes)[stated.probe]
    known.check_probe(probe, str(task))
    touched = Touched(stated.file.kind, stated.feature)
    touched.check(str(task))
    warm = stated.file.temperature
    return assess(
        arm,
        Task(
            touched=touched,
            q_rad=np.ascontiguousarray(stated.q_rad),
            probe=probe,
            label=str(task),
            noise=known.measuring(stated.noise),
            temperature_c=None if warm is None else warm.value,
            approach=stated.approach,
            payload=stated.payload,
            u_temperature_k=0.0 if warm is None or TEMPERATURE not in arm.needs else warm.u,
            inside=stated.file.inside,
            p=stated.file.p,
            digits=stated.file.digits,
        ),
        study=study,
        seed=seed,
        most_trials=most_trials,
        workers=workers,
        ledger=ledger,
        arms=known.arms,
        progress=progress,
    )


def volume_uncertainty(
    result: ResultLike | ArmLike,
    task: str | Path,
    *,
    performance: str | Path | None = None,
    seed: int = 0,
    workers: Workers | None = None,
    progress: Progress | None = None,
) -> VolumeMap:
    """How sure points and lengths are all over the volume: of a calibrated arm (a result, a `result.json`, or the
    folder of one) and a volume file; performance as for `uncertainty`. Raises UlnaInputError; KeyboardInterrupt."""
    known = _known(result, performance, seed, workers, progress)
    stated = read_volume(Path(task), known.arm)
    known.check_probe(stated.probe, str(task))
    warm = stated.file.temperature
    asked = VolumeTask(
        travel_rad=travel_or_limits(known.arm, stated.travel_rad, str(task)),
        probe=stated.probe,
        label=str(task),
        noise=known.measuring(stated.noise),
        lengths_mm=stated.lengths_mm,
        points=stated.file.points,
        bars=stated.file.bars,
        box_mm=stated.box_mm,
        temperature_c=None if warm is None else warm.value,
        payload=stated.file.payload,
        u_temperature_k=0.0 if warm is None or TEMPERATURE not in known.arm.needs else warm.u,
        p=stated.file.p,
    )
    return volume_map(known.arm, asked, seed, progress)


def _known(
    result: ResultLike | ArmLike,
    performance: str | Path | None,
    seed: int,
    workers: Workers | None,
    progress: Progress | None,
) -> Known:
    if performance is None:
        return known_of_result(result)  # type: ignore[arg-type]  # an arm alone is refused there
    return known_of_performance(result, Path(performance), seed, workers, progress)


def check_same(study: Study, made: dict[str, Any], result: Path | str) -> None:
    """Raises UlnaInputError where the result was not made from this study."""
    theirs = [file.get("sha256") for file in made.get("files", [])]
    if theirs != [file.sha256 for file in study.files]:
        raise UlnaInputError(
            f"{study.label}: {result} was not made from it, or its files have changed since; expected the study of "
            f"that calibration ({made.get('study')}). Name it, or leave --study out."
        )
