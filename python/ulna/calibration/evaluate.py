"""Evaluate: apply an arm, unchanged, to readings. Placements are fitted, the arm is not."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.given import ArmLike, arm_and_noise
from ulna.calibration.about import about_evaluation
from ulna.calibration.coverage import Coverage
from ulna.calibration.figures import figures
from ulna.calibration.held_out import judged
from ulna.calibration.likely import likely_causes
from ulna.calibration.placements import FigureEntry, Figures, PlacementFigures
from ulna.calibration.provenance import provenance
from ulna.calibration.residuals import residual_table
from ulna.calibration.result_file import EvaluatedEntry, EvaluationFile, ProvenanceEntry
from ulna.calibration.running import run_fit
from ulna.formats.for_sheets import for_sheets
from ulna.formats.output import output_folder
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.shown import About, Shown
from ulna.study.data import FitOptions
from ulna.study.given import StudyLike, as_study
from ulna.study.study import Study

FORMAT: Literal["ulna-evaluation/1"] = "ulna-evaluation/1"
FILES = ("evaluation.json", "residuals.csv")


@dataclass(repr=False)
class Evaluation(Shown):
    """What an arm makes of readings."""

    arm: Arm
    artefacts: Sequence[PlacementFigures]
    """Per artefact and placement, from the readings alone."""
    overall: Figures
    """The same over all touches and lengths together."""
    rms_mm: float
    """Root mean square of the readings' residuals, the placements fitted by least squares."""
    readings: int
    residuals: pl.DataFrame
    """One row per reading, columns as in `ulna.calibration.residuals.SCHEMA`."""
    provenance: dict[str, Any]
    coverage: Coverage | None = None
    """Whether the uncertainties that were stated of the arm hold; None of an arm of which none is known."""

    def as_dict(self) -> dict[str, Any]:
        """`evaluation.json`: JSON types only, no NaN."""
        return EvaluationFile.model_construct(
            format=FORMAT,
            arm=self.arm.name,
            parameters=dict(zip(self.arm.parameter_names, self.arm.parameters.tolist(), strict=True)),
            artefacts=[entry.entry() for entry in self.artefacts],
            overall=FigureEntry.model_construct(None, **self.overall),
            fit=EvaluatedEntry.model_construct(readings=self.readings, rms_mm=self.rms_mm),
            coverage=self.coverage,
            provenance=ProvenanceEntry.model_construct(None, **self.provenance),
        ).model_dump(mode="json", exclude_unset=True)

    def about(self) -> About:
        """Over all readings."""
        return about_evaluation(self.arm, self.readings, self.rms_mm, self.overall, self.artefacts, self.coverage)

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write `evaluation.json` and `residuals.csv` into a folder: both or none. Raises UlnaInputError."""
        with output_folder(folder, FILES, force) as staging:
            text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / "evaluation.json").write_text(text + "\n", encoding="utf-8")
            for_sheets(self.residuals).write_csv(staging / "residuals.csv")


def evaluate(arm: ArmLike, study: StudyLike, progress: Callable[[str, int, int], None] | None = None) -> Evaluation:
    """Apply `arm` to the study's readings; the study's own arm only gives the probes their names.

    `arm`: an arm, a result, or a path of one; `study`: a study or its path. Raises UlnaInputError where the arm has
    another number of joints or lacks a probe that the readings use.
    """
    (arm, noise), study = arm_and_noise(arm), as_study(study)
    # nothing of the arm is fitted, so what the study says of the fit does not matter
    fitting = dataclasses.replace(study_of_arm(study, arm), fit=FitOptions(seed=study.fit.seed))
    fitted = run_fit(fitting, lambda names: np.ones(len(names), dtype=bool), progress)
    artefacts, overall = figures(arm, fitting)
    return Evaluation(
        arm=arm,
        artefacts=artefacts,
        overall=overall,
        rms_mm=fitted.rms_mm,
        readings=sum(len(group) for group in study.readings),
        residuals=residual_table(fitting, fitted),
        provenance=provenance(study, datetime.now(UTC)),
        coverage=None
        if arm.uncertainty is None
        else judged(arm, noise, fitting).coverage(likely_causes(arm, noise, fitting, elsewhere=True)),
    )


def study_of_arm(study: Study, arm: Arm) -> Study:
    """The study's readings with the probe numbers of another arm, matched by name. Raises UlnaInputError."""
    if arm.n != study.arm.n:
        raise UlnaInputError(
            f"arm '{arm.name}' has {arm.n} joints, but the readings of {study.label} have {study.arm.n} encoder "
            "columns; expected the same number. Use the arm that was read."
        )
    theirs, ours = list(study.arm.probes), list(arm.probes)
    if theirs == ours:
        return study.with_arm(arm)
    number = np.full(len(theirs), -1, dtype=np.int64)
    for k, name in enumerate(theirs):
        if name in ours:
            number[k] = ours.index(name)
    renumbered = []
    for group in study.readings:
        probe = number[group.probe]
        if (probe < 0).any():
            name = theirs[int(group.probe[int(np.argmax(probe < 0))])]
            raise UlnaInputError(
                f"arm '{arm.name}' has no probe '{name}', which readings of artefact '{group.artefact.name}' in "
                f"{study.label} use.{nearest(name, ours)} Use an arm with that probe."
            )
        renumbered.append(dataclasses.replace(group, probe=probe))
    return dataclasses.replace(study, arm=arm, readings=renumbered)
