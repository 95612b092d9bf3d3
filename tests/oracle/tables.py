"""Tables of Denavit–Hartenberg parameters multiplied out as they stand, without the program: what a controller does."""

import csv
from typing import Literal

import numpy as np

from .chain import Array, _identity, _shift_along, _turn_about


def _link(row: dict[str, str], angle_rad: Array, convention: Literal["dh", "modified-dh"]) -> Array:
    """(N, 4, 4) of one row; a cell that is not there is 0."""
    alpha, a, d, beta = (
        np.array(float(row.get(name) or 0.0)) for name in ("alpha_rad", "a_mm", "d_mm", "beta_rad")
    )  # fmt: skip
    own = _turn_about(2, angle_rad) @ _shift_along(2, d)
    if convention == "dh":
        return own @ _shift_along(0, a) @ _turn_about(0, alpha) @ _turn_about(1, beta)
    assert beta == 0.0, "a modified table has no beta"
    return _turn_about(0, alpha) @ _shift_along(0, a) @ own


def table_frames(text: str, convention: Literal["dh", "modified-dh"], q_rad: Array) -> dict[str, Array]:
    """Columns joint, name, sign, theta0_rad, alpha_rad, a_mm, d_mm, perhaps beta_rad; (N, n) encoder angles → the
    frames (N, 4, 4), mm, of the rows `tip`, by name. turn = sign * encoder - theta0."""
    frame = _identity(len(q_rad), np.dtype(float))
    found = {}
    angles = iter(q_rad.T)
    for row in csv.DictReader(text.splitlines()):
        zero = np.array(float(row["theta0_rad"]))
        if row["joint"] == "tip":
            found[row["name"]] = frame @ _link(row, -zero, convention)
        else:
            frame = frame @ _link(row, float(row["sign"]) * next(angles) - zero, convention)
    assert next(angles, None) is None, "a joint has no row"
    return found
