"""Rigid transforms: (3, 3) rotations and (4, 4) poses, mm and rad; fixed angles roll, pitch, yaw as URDF means them."""

from __future__ import annotations

import math

import numpy as np

from ulna.ground.arrays import F64

#: below this cosine of the pitch, roll and yaw turn about the same axis up to rounding
_GIMBAL = 1e-15


def turn(axis: str, angle_rad: float) -> F64:
    """(3, 3) rotation about x, y or z."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def pose(r: F64, p_mm: F64) -> F64:
    """(4, 4) from a rotation and a shift."""
    t = np.eye(4)
    t[:3, :3] = r
    t[:3, 3] = p_mm
    return t


def inverse(t: F64) -> F64:
    """(4, 4) of a rigid transform."""
    r = t[:3, :3].T
    return pose(r, -r @ t[:3, 3])


def from_rpy(roll: float, pitch: float, yaw: float) -> F64:
    """(3, 3): roll about the fixed x, then pitch about the fixed y, then yaw about the fixed z (URDF)."""
    return turn("z", yaw) @ turn("y", pitch) @ turn("x", roll)


def to_rpy(r: F64, near: F64 | None = None) -> F64:
    """(3,) roll, pitch, yaw of a rotation; of all that there are, the ones nearest to `near`, or to zero.

    Each angle is taken from what the angles before it leave over, so that `from_rpy` gives the rotation back to
    rounding also where the pitch is a quarter turn and roll and yaw are one.
    """
    near = np.zeros(3) if near is None else near
    found = []
    degenerate = math.hypot(r[0, 0], r[1, 0]) < _GIMBAL
    for half in (0.0, math.pi):
        yaw = float(near[2]) if degenerate else math.atan2(r[1, 0], r[0, 0]) + half
        rest = turn("z", -yaw) @ r
        pitch = math.atan2(-rest[2, 0], rest[0, 0])
        rest = turn("y", -pitch) @ rest
        angles = np.array([math.atan2(rest[2, 1], rest[1, 1]), pitch, yaw])
        found.append(angles - 2 * math.pi * np.round((angles - near) / (2 * math.pi)))
    return min(found, key=lambda angles: float(np.abs(angles - near).sum()))


def apart(one_rad: float, other_rad: float) -> float:
    """How far two angles are from each other, whole turns aside: 0 … π."""
    return abs(math.remainder(one_rad - other_rad, 2 * math.pi))


def smallest_turn(w: F64) -> F64:
    """(3, 3) the smallest rotation that brings z to the unit vector w, which does not point along -z."""
    x, y, z = w
    # (1 - cos) / sin² about z × w; the other form where 1 + z would keep few digits, and R no rotation
    k = 1.0 / (1.0 + z) if z > 0 else (1.0 - z) / (x * x + y * y)
    return np.array([[1.0 - k * x * x, -k * x * y, x], [-k * x * y, 1.0 - k * y * y, y], [-x, -y, z]])
