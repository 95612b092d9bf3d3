"""Rotations as people and instruments write them, as matrices.

A rotation vector is the axis times the angle. Angles about axes are named by the order in which they turn, as SciPy
does: "xyz" about axes that stay, "XYZ" about axes that turn along, so that "XYZ" is Rx Ry Rz and "xyz" Rz Ry Rx.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np

from ulna.ground.arrays import F64

SEQUENCES = tuple("".join(each) for letters in ("xyz", "XYZ") for each in permutations(letters))
"""Orders of turns about three axes."""


def cross_matrices(vectors: F64) -> F64:
    """[v]× of (…, 3), (…, 3, 3)."""
    found = np.zeros((*vectors.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., i, j], found[..., j, i] = -vectors[..., k], vectors[..., k]
    return found


def matrices_of_vectors(vectors_rad: F64) -> F64:
    """(N, 3) rotation vectors → (N, 3, 3), by Rodrigues' formula."""
    angle = np.linalg.norm(vectors_rad, axis=1)
    turning = angle > 0.0
    axis = np.where(turning[:, None], vectors_rad / np.where(turning, angle, 1.0)[:, None], 0.0)
    skew = cross_matrices(axis)
    sine, versine = np.sin(angle)[:, None, None], (1.0 - np.cos(angle))[:, None, None]
    found: F64 = np.eye(3) + sine * skew + versine * (skew @ skew)
    return found


def vectors_of_matrices(matrices: F64) -> F64:
    """(N, 3, 3) → (N, 3) rotation vectors, of length 0 to π.

    By the quaternion whose largest element is taken from the diagonal, so that no half turn is lost (Shepperd 1978).
    """
    m, trace = matrices, np.trace(matrices, axis1=1, axis2=2)
    squares = np.column_stack([trace, *(2.0 * m[:, k, k] - trace for k in range(3))])
    largest = squares.argmax(axis=1)
    quaternion = np.empty((len(m), 4))
    for k in range(4):
        own = np.flatnonzero(largest == k)
        quaternion[own] = _with_largest(m[own], k, np.sqrt(1.0 + squares[own, k]))
    quaternion *= np.where(quaternion[:, :1] < 0.0, -1.0, 1.0)
    sine = np.linalg.norm(quaternion[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(sine, quaternion[:, 0])
    found: F64 = quaternion[:, 1:] * np.where(sine > 0.0, angle / np.where(sine > 0.0, sine, 1.0), 2.0)[:, None]
    return found


def _with_largest(m: F64, k: int, twice: F64) -> F64:
    """Quaternions (w, x, y, z) of matrices whose element k is the largest; twice: its double."""
    found = np.empty((len(m), 4))
    found[:, k] = 0.5 * twice
    if k == 0:
        for i, (a, b) in enumerate(((2, 1), (0, 2), (1, 0)), start=1):
            found[:, i] = 0.5 * (m[:, a, b] - m[:, b, a]) / twice
        return found
    i, j = k % 3 + 1, (k + 1) % 3 + 1
    found[:, 0] = 0.5 * (m[:, j - 1, i - 1] - m[:, i - 1, j - 1]) / twice
    for other in (i, j):
        found[:, other] = 0.5 * (m[:, k - 1, other - 1] + m[:, other - 1, k - 1]) / twice
    return found


def matrices_of_angles(angles_rad: F64, sequence: str) -> F64:
    """(N, 3) angles about x, y and z → (N, 3, 3). sequence: one of `SEQUENCES`, the order in which they turn."""
    about = {}
    for axis, name in enumerate("xyz"):
        vectors = np.zeros_like(angles_rad)
        vectors[:, axis] = angles_rad[:, axis]
        about[name] = matrices_of_vectors(vectors)
    first, second, third = (about[name] for name in sequence.lower())
    found: F64 = third @ second @ first if sequence.islower() else first @ second @ third
    return found


def matrices_of_quaternions(quaternions: F64) -> F64:
    """(N, 4) w, x, y, z of any length but 0 → (N, 3, 3)."""
    w, x, y, z = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
