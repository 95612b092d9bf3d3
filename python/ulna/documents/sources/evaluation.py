"""An evaluation: readings that this arm was judged by and not fitted to."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Calibration, Source
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError

FORMAT = "ulna-evaluation"


def _read(path: Path, _: Calibration) -> tuple[dict[str, Any], str]:
    document, digest = read_json(path, "an evaluation.json")
    check_format(document, path, FORMAT)
    return document, digest


def _remarks(document: dict[str, Any], path: Path, calibration: Calibration) -> list[Said]:
    """Readings that were fitted too, and an arm that is not told; another arm is refused."""
    same = _is_of(calibration.result.arm, document, path)
    fitted = {file["sha256"] for file in calibration.result.provenance.get("files", []) if file.get("rows", 0)}
    judged = [file["sha256"] for file in document.get("provenance", {}).get("files", [])][1:]
    said = [Said("held-out.same-readings", {"file": path.name})] if fitted & set(judged) else []
    if not same:
        said.append(Said("held-out.unknown-arm", {"file": path.name, "arm": str(document.get("arm", "–"))}))
    return said


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


EVALUATION = Source("evaluation", FORMAT, _read, _remarks)
