"""What a calibrated arm makes of the places that were held out of its session. Lengths mm."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.given import arm_and_noise
from ulna.calibration.evaluate import Evaluation, evaluate
from ulna.calibration.figures import overall_figures
from ulna.calibration.held_out import judged
from ulna.calibration.placements import Figures
from ulna.calibration.result import Result
from ulna.study.file import study_file
from ulna.study.study import Study

FOLDER, FILE = "held-out", "evaluation.json"
"""Beside the study."""


@dataclass(frozen=True)
class HeldOut:
    """Figures and intervals of these places."""

    places: int
    evaluation: Evaluation
    """As `ulna evaluate` has it."""
    before: Figures
    """The same figures of the arm where the session began."""
    expected_mm: float | None
    """Root mean square of length errors as it is expected from what is known; None where no lengths were touched."""

    def as_dict(self) -> dict[str, Any]:
        """JSON types only."""
        found = self.evaluation
        return {
            "places": self.places,
            "readings": found.readings,
            "rms_mm": found.rms_mm,
            "overall": dict(found.overall),
            "before": dict(self.before),
            "expected_length_error_rms_mm": self.expected_mm,
            "coverage": None if found.coverage is None else asdict(found.coverage),
        }


def judgement(result: Path) -> Path | None:
    """What was written of the places held out by the session whose result.json it is; None where there is none."""
    path = result.parent.parent / FOLDER / FILE
    return path if path.is_file() else None


def judge(result: Result, study: Path, begun: Arm) -> HeldOut | None:
    """The places held out, by an arm that was not fitted to them; written beside the study as `ulna evaluate` does.
    None where there are none. Raises UlnaInputError."""
    if all(entry.split is None for entry in study_file(study).readings):
        return None
    kept = Study.load(study, "check")
    found = evaluate(result, kept)
    found.save(study.parent / FOLDER)
    arm, noise = arm_and_noise(result)
    errors_mm = judged(arm, noise, kept.with_arm(arm)).errors_mm
    expected_mm = float(np.sqrt((errors_mm[:, 1] ** 2).mean())) if len(errors_mm) else None
    return HeldOut(len(found.artefacts), found, overall_figures(begun, kept.with_arm(begun)), expected_mm)
