"""A chain in the modified Denavit–Hartenberg form, as Craig writes it: 4×4 matrices, one factor after the other."""

from collections.abc import Sequence

import numpy as np

from .chain import Array, _identity, _shift_along, _turn_about

#: Franka Emika Panda, from the maker: a, d in mm and alpha in rad of each row, before the joint; then the flange.
PANDA = {
    "a": [0.0, 0.0, 0.0, 82.5, -82.5, 0.0, 88.0],
    "d": [333.0, 0.0, 316.0, 0.0, 384.0, 0.0, 0.0],
    "alpha": [0.0, -np.pi / 2, np.pi / 2, np.pi / 2, -np.pi / 2, np.pi / 2, np.pi / 2],
}
PANDA_FLANGE_MM = 107.0


def craig_tips(
    alpha_rad: Sequence[float],
    a_mm: Sequence[float],
    theta0_rad: Sequence[float],
    d_mm: Sequence[float],
    sign: Sequence[int],
    tip_mm: Array,
    q_rad: Array,
) -> Array:
    """(N, n) encoder angles → (N, 3) tips in the table's frame, mm; alpha and a of a row stand before its joint."""
    frame = _identity(len(q_rad), np.dtype(float))
    for k in range(q_rad.shape[1]):
        frame = frame @ _turn_about(0, np.array(alpha_rad[k])) @ _shift_along(0, np.array(a_mm[k]))
        frame = frame @ _turn_about(2, sign[k] * q_rad[:, k] - theta0_rad[k]) @ _shift_along(2, np.array(d_mm[k]))
    return frame[:, :3, :3] @ np.asarray(tip_mm) + frame[:, :3, 3]
