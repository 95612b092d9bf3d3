"""Whether the uncertainties that were stated hold on readings that the fit has not seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pydantic import TypeAdapter, ValidationError

from ulna.calibration.coverage import Coverage
from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.held_out import judged
from ulna.calibration.likely import likely_causes
from ulna.calibration.result import Result
from ulna.documents.content.held_out import kept_to_check
from ulna.documents.sources.source import Taken
from ulna.ground.errors import UlnaInputError
from ulna.study.study import Study

_COVERAGE: TypeAdapter[Coverage | None] = TypeAdapter(Coverage | None)


@dataclass(frozen=True)
class JudgedReadings:
    """What held on one set of readings."""

    readings: str
    """"check", "left-out" or "evaluated", as in a row of the before/after table."""
    coverage: Coverage


def coverages(
    result: Result, study: Study | None, cross_validation: Taken[Any] | None, evaluation: Taken[Any] | None
) -> list[JudgedReadings]:
    """Of rows kept to check, of groups left out, of an evaluation; those that there are and that could be judged.
    Raises UlnaInputError for a damaged file."""
    found = {
        "check": _checked(result, study),
        "left-out": None if cross_validation is None else _of_file(cross_validation),
        "evaluated": None if evaluation is None else _of_file(evaluation),
    }
    return [JudgedReadings(readings, each) for readings, each in found.items() if each is not None and each.shares]


def _checked(result: Result, study: Study | None) -> Coverage | None:
    check = None if study is None else kept_to_check(study)
    if check is None:
        return None
    arm, noise = result.arm, result.noise
    fitting = study_of_arm(check, arm)
    return judged(arm, noise, fitting).coverage(likely_causes(arm, noise, fitting, elsewhere=False))


def _of_file(taken: Taken[Any]) -> Coverage | None:
    try:
        return _COVERAGE.validate_python(taken.value.get("coverage"))
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(["coverage", *(str(part) for part in first["loc"])])
        raise UlnaInputError(
            f"{taken.file.path}: key '{key}': {first['msg'][:1].lower()}{first['msg'][1:]}. The file was changed or "
            "damaged: make it again."
        ) from None
