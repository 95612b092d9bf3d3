"""The before/after table: what a metrologist reads, on the fitted readings and on readings held out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.figures import overall_figures
from ulna.calibration.placements import Figures
from ulna.calibration.result import Result
from ulna.documents.content import QualityRow, ReadFile, Said, Summary
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError
from ulna.study.file import rows_to_judge
from ulna.study.study import Study

#: quantity → its mean, RMS and largest among the figures; the others have no more than one number
DISTRIBUTED = {
    "length_error": ("length_error_mean_mm", "length_error_rms_mm", "length_error_max_abs_mm"),
    "seat_scatter": ("seat_scatter_mean_mm", "seat_scatter_rms_mm", "seat_scatter_max_mm"),
    "coordinate_error": ("coordinate_error_mean_mm", "coordinate_error_rms_mm", "coordinate_error_max_mm"),
}
WORST = {"form": "form_mm", "diameter_error": "diameter_error_mm"}
#: what is said of held-out readings that weakens what they show
CAUTIONS = ("held-out.none", "held-out.same-readings", "held-out.other-study", "held-out.unknown-arm")


def quality_rows(readings: str, before: Figures | None, after: Figures) -> list[QualityRow]:
    """A row for every quantity that these readings give."""
    rows = []
    for quantity in (*DISTRIBUTED, *WORST):
        old, new = (None if each is None else _summary(quantity, each) for each in (before, after))
        if old is not None or new is not None:
            rows.append(QualityRow(quantity, readings, old, new, quantity == "length_error"))
    return rows


def residual_row(result: Result) -> QualityRow | None:
    """Sizes of the fitted readings' residuals; of the start only their RMS is kept."""
    size_mm = result.residuals["norm_mm"].to_numpy()
    if not len(size_mm):
        return None
    before = Summary(math.nan, result.fit.rms_start_mm, math.nan)
    after = Summary(float(size_mm.mean()), result.fit.rms_mm, float(size_mm.max()))
    return QualityRow("residual", "fitted", before, after, False)


def _summary(quantity: str, found: Mapping[str, float]) -> Summary | None:
    if quantity in WORST:
        # of each placement one number, and the largest of them is all that is kept
        value = found.get(WORST[quantity])
        return None if value is None else Summary(math.nan, math.nan, value)
    values = [found.get(name) for name in DISTRIBUTED[quantity]]
    mean, rms, most = values
    if mean is None or rms is None or most is None:
        return None
    return Summary(mean, rms, most)


def held_out(
    result: Result, study: Study | None, cross_validation: Path | None, evaluation: Path | None
) -> tuple[list[QualityRow], list[Said], list[ReadFile]]:
    """Rows on readings that the fit has not seen, and what they are; where there are none, what would be needed; and
    the files that were read for that.

    Rows that the study keeps to check, groups left out in a cross-validation, an evaluation on another study. Raises
    UlnaInputError for a file that is none of that, and for an evaluation of an arm with other parameters.
    """
    files: list[ReadFile] = []
    rows: list[QualityRow] = []
    said: list[Said] = []
    if study is not None and study.path is not None and study.rows == "fit" and rows_to_judge(study.path) == "check":
        check = Study.load(study.path, "check")
        after = overall_figures(result.arm, study_of_arm(check, result.arm))
        before = overall_figures(start_of(result), study_of_arm(check, result.arm))
        rows += quality_rows("check", before, after)
        said.append(Said("held-out.check", {"readings": sum(len(group) for group in check.readings)}))
    if cross_validation is not None:
        document, digest = read_json(cross_validation, "a cross-validation.json")
        check_format(document, cross_validation, "ulna-cross-validation")
        files.append(ReadFile(cross_validation.name, digest))
        rows += quality_rows("left-out", document["before"], document["after"])
        values = {"by": str(document.get("by", "")), "groups": len(document["groups"]), "file": cross_validation.name}
        said.append(Said("held-out.left-out", values))
        if _sources(document) != _sources({"provenance": result.provenance}):
            said.append(Said("held-out.other-study", {"file": cross_validation.name}))
    if evaluation is not None:
        document, digest = read_json(evaluation, "an evaluation.json")
        check_format(document, evaluation, "ulna-evaluation")
        files.append(ReadFile(evaluation.name, digest))
        same = _is_of(result.arm, document, evaluation)
        rows += quality_rows("evaluated", None, document["overall"])
        readings = sum(int(entry.get("readings", 0)) for entry in document["artefacts"])
        said.append(Said("held-out.evaluated", {"readings": readings, "file": evaluation.name}))
        if set(_sources(document)[1:]) & set(_data_sources(result.provenance)):
            said.append(Said("held-out.same-readings", {"file": evaluation.name}))
        if not same:
            said.append(Said("held-out.unknown-arm", {"file": evaluation.name, "arm": str(document.get("arm", "–"))}))
    if not rows:
        said.append(Said("held-out.none"))
    return rows, said, files


def _is_of(arm: Arm, document: Mapping[str, Any], path: Path) -> bool:
    """Whether an evaluation is of this arm; False where it does not say, as before its key `parameters`. Raises
    UlnaInputError where it is of another."""
    given = document.get("parameters")
    if not isinstance(given, dict):
        return False
    for name, value in zip(arm.parameter_names, arm.parameters.tolist(), strict=True):
        other = given.get(name)
        if not isinstance(other, int | float) or not np.isclose(other, value, rtol=1e-9, atol=1e-12):
            shown = "missing" if other is None else f"{other}"
            raise UlnaInputError(
                f"{path}: is an evaluation of another arm ('{document.get('arm')}'): its parameters.{name} is {shown}, "
                f"expected {value!r}, as in the result. Evaluate this result (ulna evaluate RESULT STUDY -o FOLDER) "
                "and give that file."
            )
    return True


def start_of(result: Result) -> Arm:
    """The arm that the fit started from, with the signs that it found."""
    start = {row.name: row.start for row in result.parameters}
    return result.arm.with_parameters([start[name] for name in result.arm.parameter_names])


def _sources(document: Mapping[str, Any]) -> list[str]:
    return [file["sha256"] for file in document.get("provenance", {}).get("files", [])]


def _data_sources(made: Mapping[str, Any]) -> list[str]:
    return [file["sha256"] for file in made.get("files", []) if file.get("rows", 0)]
