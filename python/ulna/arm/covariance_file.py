"""What a result.json says of its parameters' uncertainty, checked: a damaged matrix would give quiet nonsense."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ulna.arm.covariance import ParameterCovariance
from ulna.arm.data import ArmData
from ulna.arm.unknown import why_unknown
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest

_SLACK = 1e-6
"""Rounding that is forgiven, in units of correlation."""


def covariance_of_result(document: dict[str, Any], arm: ArmData, path: Path) -> ParameterCovariance:
    """The keys `covariance` and `identifiability.lost` of a result document: of all its parameters, the dimensions of
    artefacts too. Raises UlnaInputError."""
    try:
        names = list(document["covariance"]["names"])
        rows = document["covariance"]["matrix"]
        lost = list(document["identifiability"]["lost"])
    except (KeyError, TypeError) as error:
        damaged(path, "covariance", f"the tables are not as ulna-result/1 says ({type(error).__name__}: {error})")
    for name in names:
        _known(name, arm, path, "covariance.names")
    if len(set(names)) != len(names):
        damaged(path, "covariance.names", "a name stands twice")
    for number, direction in enumerate(lost, start=1):
        _check_direction(direction, arm, path, f"identifiability.lost.{number}")
    matrix = _matrix(rows, names, path)
    fit = document.get("fit")
    unknown = why_unknown(fit if isinstance(fit, dict) else {})
    return ParameterCovariance(names, matrix, [dict(direction) for direction in lost], unknown)


def _matrix(rows: Any, names: list[str], path: Path) -> F64:
    size = len(names)
    if not (isinstance(rows, list) and all(isinstance(row, list) and len(row) == size for row in rows)) or (
        len(rows) != size
    ):
        damaged(path, "covariance.matrix", f"expected a square matrix of {size} rows, one per name")
    cells = [value for row in rows for value in row]
    if cells and all(value is None for value in cells):
        return np.full((size, size), np.nan)  # the calibration could not estimate it
    for k, value in enumerate(cells):
        if not is_number(value):
            at = f"{names[k // size]}, {names[k % size]}"
            damaged(path, "covariance.matrix", f"got {str(value)[:40]} for {at}; expected a finite number")
    matrix = np.array(rows, dtype=np.float64).reshape(size, size)
    variance = np.diag(matrix)
    if (variance < 0).any():
        k = int(np.argmax(variance < 0))
        damaged(path, "covariance.matrix", f"the variance of {names[k]} is {variance[k]:g}; expected 0 or more")
    with np.errstate(over="ignore"):  # of numbers that no calibration gives; they are refused as not symmetric
        u = np.sqrt(variance)
        scale = np.outer(np.where(u > 0, u, 1.0), np.where(u > 0, u, 1.0))
        correlation = matrix / scale
        unequal = np.abs(correlation - correlation.T) > _SLACK
    if unequal.any():
        i, k = (int(at[0]) for at in np.nonzero(unequal))
        damaged(path, "covariance.matrix", f"it is not symmetric in {names[i]}, {names[k]}")
    if size and np.linalg.eigvalsh((correlation + correlation.T) / 2).min() < -_SLACK * size:
        damaged(path, "covariance.matrix", "some combination of parameters has a negative variance")
    return matrix


def _check_direction(direction: Any, arm: ArmData, path: Path, key: str) -> None:
    weights = direction.get("combination") if isinstance(direction, dict) else None
    if not isinstance(weights, dict) or not weights:
        damaged(path, f"{key}.combination", "expected a table of parameters and weights")
    for name, weight in weights.items():
        _known(name, arm, path, f"{key}.combination")
        if not is_number(weight):
            damaged(path, f"{key}.combination", f"got {str(weight)[:40]} for {name}; expected a finite number")
    for text in ("because", "remedy"):
        if not isinstance(direction.get(text), str):
            damaged(path, f"{key}.{text}", "expected a text")


def _known(name: Any, arm: ArmData, path: Path, key: str) -> None:
    if name not in arm.parameter_names and not str(name).startswith("artefact."):
        damaged(
            path,
            key,
            f"got {str(name)[:60]!r}, which is no parameter of the arm in this file"
            + nearest(str(name), arm.parameter_names).rstrip("."),
        )


def is_number(value: Any) -> bool:
    """A finite one."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def damaged(path: Path, key: str, what: str) -> NoReturn:
    """Raises UlnaInputError: a key of a result says what no calibration writes."""
    end = "" if what[-1] in ".?" else "."
    raise UlnaInputError(f"{path}: key '{key}': {what}{end} The file was changed or damaged: calibrate again.")
