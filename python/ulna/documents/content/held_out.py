"""Readings that the fit has not seen: rows kept to check, groups left out, an evaluation; or what would be needed."""

from __future__ import annotations

from ulna.arm.arm import Arm
from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.figures import overall_figures
from ulna.calibration.placements import figures_of
from ulna.calibration.result import Result
from ulna.calibration.result_file import CrossValidationFile, EvaluationFile
from ulna.documents.content.quality import QualityRow, quality_rows
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Taken
from ulna.study.file import rows_to_judge
from ulna.study.study import Study

#: what is said of held-out readings that weakens what they show
CAUTIONS = ("held-out.none", "held-out.same-readings", "held-out.other-study", "held-out.unknown-arm")

Rows = tuple[list[QualityRow], list[Said]]


def held_out(
    result: Result,
    study: Study | None,
    cross_validation: Taken[CrossValidationFile] | None,
    evaluation: Taken[EvaluationFile] | None,
) -> Rows:
    """Rows on readings that the fit has not seen, and what they are."""
    rows: list[QualityRow] = []
    said: list[Said] = []
    parts: list[Rows] = []
    check = None if study is None else kept_to_check(study)
    if check is not None:
        parts += _checked(result, check)
    if cross_validation is not None:
        parts.append(_left_out(cross_validation))
    if evaluation is not None:
        parts.append(_evaluated(evaluation))
    for own_rows, own_said in parts:
        rows += own_rows
        said += own_said
    return rows, said if rows else [*said, Said("held-out.none")]


def kept_to_check(study: Study) -> Study | None:
    """Rows that a study keeps to check the fit; None where it keeps none."""
    if study.path is None or study.rows != "fit" or rows_to_judge(study.path) != "check":
        return None
    return Study.load(study.path, "check")


def _checked(result: Result, check: Study) -> list[Rows]:
    after = overall_figures(result.arm, study_of_arm(check, result.arm))
    before = overall_figures(start_of(result), study_of_arm(check, result.arm))
    count = sum(len(group) for group in check.readings)
    return [(quality_rows("check", before, after), [Said("held-out.check", {"readings": count})])]


def _left_out(taken: Taken[CrossValidationFile]) -> Rows:
    file = taken.value
    values = {"by": file.by or "", "groups": len(file.groups), "file": taken.file.name}
    rows = quality_rows("left-out", figures_of(file.before), figures_of(file.after))
    return rows, [Said("held-out.left-out", values), *taken.remarks]


def _evaluated(taken: Taken[EvaluationFile]) -> Rows:
    readings = sum(entry.readings for entry in taken.value.artefacts)
    said = Said("held-out.evaluated", {"readings": readings, "file": taken.file.name})
    return quality_rows("evaluated", None, figures_of(taken.value.overall)), [said, *taken.remarks]


def start_of(result: Result) -> Arm:
    """The arm that the fit started from, with the signs that it found."""
    start = {row.name: row.start for row in result.parameters}
    return result.arm.with_parameters([start[name] for name in result.arm.parameter_names])
