"""What a result.json says of each parameter, against the arm and the covariance that stand in the same file: where they
contradict each other, what is measured with it and what is certified of it would be two arms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.covariance import ParameterCovariance
from ulna.arm.covariance_file import damaged, is_number
from ulna.arm.data import ArmData

EQUAL = 1e-9
"""Rounding of numbers that are written twice, in mm or rad and relative."""
OF_U = 1e-6


def check_parameters(document: dict[str, Any], arm: ArmData, known: ParameterCovariance, path: Path) -> None:
    """Every parameter of the arm stands there once, with the arm's value and unit; those that were fitted are those of
    the covariance, and their u its roots. Raises UlnaInputError."""
    rows = document.get("parameters")
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        damaged(path, "parameters", "expected a list of the arm's parameters")
    by_name = {str(row.get("name")): row for row in rows}
    if len(by_name) != len(rows):
        damaged(path, "parameters", "a name stands twice")
    u = dict(zip(known.names, np.sqrt(np.maximum(np.diag(known.matrix), 0.0)).tolist(), strict=True))
    for name, unit, value in zip(arm.parameter_names, arm.parameter_units, arm.parameters.tolist(), strict=True):
        row, key = by_name.get(name), f"parameters: {name}"
        if row is None:
            damaged(path, key, "is missing, which the arm in this file has")
        if row.get("unit") != unit:
            damaged(path, key, f"its unit is {str(row.get('unit'))[:20]!r}, but it is in {unit}")
        stated = row.get("value")
        if not is_number(stated):
            damaged(path, key, f"got {str(stated)[:40]!r}, expected a number")
        if abs(stated - value) > EQUAL * max(1.0, abs(value)):
            damaged(path, key, f"got {stated:.10g}, but the arm in this file has {value:.10g}")
        _check_status(row, name, u, path, key)


def _check_status(row: dict[str, Any], name: str, u: dict[str, float], path: Path, key: str) -> None:
    status, stated = row.get("status"), row.get("u")
    if status not in ("fitted", "held", "not-determined"):
        damaged(path, key, f"its status is {str(status)[:20]!r}; expected fitted, held or not-determined")
    if (status == "held") == (name in u):
        free = "it was free" if name in u else "it was not free"
        damaged(path, key, f"its status is {status!r}, but by the covariance in this file {free}")
    if stated is None or status != "fitted":
        return
    if not is_number(stated):
        damaged(path, key, f"its u is {str(stated)[:40]!r}; expected a number")
    expected = u[name]
    if math.isfinite(expected) and abs(stated - expected) > OF_U * max(abs(expected), 1e-300):
        damaged(path, key, f"its u is {stated:.6g}, but by the covariance in this file {expected:.6g}")
