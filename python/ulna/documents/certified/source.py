"""The result that a certificate is made of: read, and checked for contradictions that a certificate would carry on."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NoReturn

from ulna.documents.certified.parameters import StatedParameters, stated_parameters
from ulna.documents.sources.result import read_calibration
from ulna.documents.sources.source import Calibration
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError

#: no figure in mm comes near it
MOST = 1e300

#: whole numbers up to here are doubles too
MOST_COUNTED = 2**53


def certified_result(path: Path) -> tuple[Calibration, StatedParameters]:
    """A result.json, and what can be stated of its parameters.

    Raises UlnaInputError for a file that was changed or damaged, and for a fit that did not converge.
    """
    document, _ = read_json(path, "a result.json")
    check_format(document, path, "ulna-result")
    calibration = read_calibration(path)
    result = calibration.result
    _check_overall(document, path)
    if not result.fit.converged:
        raise UlnaInputError(
            f"{path}: key 'fit.converged': the calibration did not converge ({result.fit.termination}); expected one "
            "that did. Calibrate again before you certify it."
        )
    for number, file in enumerate(result.provenance["files"], start=1):
        if not isinstance(file.get("path"), str) or not isinstance(file.get("sha256"), str):
            _damaged(path, f"provenance.files.{number}", "expected texts path and sha256")
    for key in ("readings", "degrees_of_freedom"):
        if not 0 <= getattr(result.fit, key) <= MOST_COUNTED:
            _damaged(path, f"fit.{key}", f"expected a number from 0 to {MOST_COUNTED:g}")
    stated = stated_parameters(result)
    if not (math.isfinite(stated.k) and math.isfinite(stated.k_region)):
        _damaged(path, "fit.degrees_of_freedom", f"{stated.degrees_of_freedom:g} give no coverage factor")
    return calibration, stated


def _check_overall(document: dict[str, Any], path: Path) -> None:
    """The figures over all are finite numbers by name."""
    overall = document.get("overall")
    for when in ("before", "after"):
        figures = overall.get(when) if isinstance(overall, dict) else None
        if not isinstance(figures, dict):
            _damaged(path, f"overall.{when}", "expected a table of figures")
        for name, value in figures.items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= MOST:
                _damaged(path, f"overall.{when}.{name}", f"got {str(value)[:40]!r}, expected a number")


def _damaged(path: Path, key: str, what: str) -> NoReturn:
    raise UlnaInputError(f"{path}: key '{key}': {what}. The file was changed or damaged: calibrate again.")
