"""Whether the uncertainties that were stated hold on readings that the fit has not seen."""

from __future__ import annotations

from dataclasses import dataclass

from ulna.calibration.coverage import Coverage
from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.held_out import judged
from ulna.calibration.likely import likely_causes
from ulna.calibration.result import Result
from ulna.calibration.result_file import CrossValidationFile, EvaluationFile
from ulna.documents.content.held_out import kept_to_check
from ulna.documents.sources.source import Taken
from ulna.study.study import Study


@dataclass(frozen=True)
class JudgedReadings:
    """What held on one set of readings."""

    readings: str
    """"check", "left-out" or "evaluated", as in a row of the before/after table."""
    coverage: Coverage


def coverages(
    result: Result,
    study: Study | None,
    cross_validation: Taken[CrossValidationFile] | None,
    evaluation: Taken[EvaluationFile] | None,
) -> list[JudgedReadings]:
    """Of rows kept to check, of groups left out, of an evaluation; those that there are and that could be judged."""
    found = {
        "check": _checked(result, study),
        "left-out": None if cross_validation is None else cross_validation.value.coverage,
        "evaluated": None if evaluation is None else evaluation.value.coverage,
    }
    return [JudgedReadings(readings, each) for readings, each in found.items() if each is not None and each.shares]


def _checked(result: Result, study: Study | None) -> Coverage | None:
    check = None if study is None else kept_to_check(study)
    if check is None:
        return None
    arm, noise = result.arm, result.noise
    fitting = study_of_arm(check, arm)
    return judged(arm, noise, fitting).coverage(likely_causes(arm, noise, fitting, elsewhere=False))
