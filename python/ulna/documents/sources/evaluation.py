"""An evaluation: readings that this arm was judged by and not fitted to."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.calibration.result_file import EvaluationFile
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source, json_of
from ulna.ground.errors import UlnaInputError

FORMAT = "ulna-evaluation"


def _remarks(file: EvaluationFile, path: Path, calibration: Calibration) -> list[Said]:
    """Readings that were fitted too, and an arm that is not told; another arm is refused."""
    same = _is_of(calibration.result.arm, file, path)
    fitted = {each["sha256"] for each in calibration.result.provenance.get("files", []) if each.get("rows", 0)}
    judged = [] if file.provenance is None else [each["sha256"] for each in file.provenance.files][1:]
    said = [Said("held-out.same-readings", {"file": path.name})] if fitted & set(judged) else []
    if not same:
        said.append(Said("held-out.unknown-arm", {"file": path.name, "arm": file.arm or "–"}))
    return said


def _is_of(arm: Arm, file: EvaluationFile, path: Path) -> bool:
    """Whether an evaluation is of this arm; False where it does not say, as before its key `parameters`. Raises
    UlnaInputError where it is of another."""
    given = file.parameters
    if given is None:
        return False
    for name, value in zip(arm.parameter_names, arm.parameters.tolist(), strict=True):
        other = given.get(name)
        if other is None or not np.isclose(other, value, rtol=1e-9, atol=1e-12):
            shown = "missing" if other is None else f"{other}"
            raise UlnaInputError(
                f"{path}: is an evaluation of another arm ('{file.arm}'): its parameters.{name} is {shown}, "
                f"expected {value!r}, as in the result. Evaluate this result (ulna evaluate RESULT STUDY -o FOLDER) "
                "and give that file."
            )
    return True


EVALUATION = Source("evaluation", FORMAT, json_of(FORMAT, "an evaluation.json", EvaluationFile), _remarks)
