"""Rotations in all ways of writing them, beside SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ulna.geometry.rigid import rotations
from ulna.geometry.rotation import (
    SEQUENCES,
    matrices_of_angles,
    matrices_of_quaternions,
    matrices_of_vectors,
    vectors_of_matrices,
)


def vectors(count: int = 200) -> np.ndarray:
    """Of every size up to a whole turn, none, tiny, and half turns about axes and anything."""
    rng = np.random.default_rng(1)
    drawn = rng.standard_normal((count, 3))
    drawn *= (rng.uniform(0.0, 2.0 * np.pi, count) / np.linalg.norm(drawn, axis=1))[:, None]
    halves = np.array([[np.pi, 0.0, 0.0], [0.0, np.pi, 0.0], [0.0, 0.0, np.pi]])
    skew = np.pi / np.sqrt(3.0) * np.array([[1.0, -1.0, 1.0]])
    return np.concatenate([drawn, np.zeros((1, 3)), 1e-9 * drawn[:3], halves, skew])


def test_vectors_to_matrices() -> None:
    given = vectors()
    np.testing.assert_allclose(matrices_of_vectors(given), Rotation.from_rotvec(given).as_matrix(), atol=1e-14)


def test_matrices_to_vectors_and_back() -> None:
    turns = matrices_of_vectors(vectors())
    back = vectors_of_matrices(turns)
    np.testing.assert_allclose(matrices_of_vectors(back), turns, atol=1e-13)
    assert (np.linalg.norm(back, axis=1) <= np.pi + 1e-12).all()
    small = 1e-7 * vectors(20)
    np.testing.assert_allclose(vectors_of_matrices(matrices_of_vectors(small)), small, atol=1e-15)


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_angles(sequence: str) -> None:
    """Columns are about x, y, z, whatever the order in which they turn."""
    about = np.random.default_rng(2).uniform(-3.0, 3.0, (50, 3))
    turned = about[:, ["xyz".index(axis) for axis in sequence.lower()]]
    expected = Rotation.from_euler(sequence, turned).as_matrix()
    np.testing.assert_allclose(matrices_of_angles(about, sequence), expected, atol=1e-14)


def test_quaternions() -> None:
    given = np.random.default_rng(3).standard_normal((50, 4))
    expected = Rotation.from_quat(given[:, [1, 2, 3, 0]]).as_matrix()
    np.testing.assert_allclose(matrices_of_quaternions(given), expected, atol=1e-14)


def test_the_nearest_rotation() -> None:
    """As SciPy aligns vectors, also where the nearest orthogonal matrix is a mirror image."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        a, b = rng.standard_normal((2, 10, 3))
        expected = Rotation.align_vectors(a, b)[0].as_matrix()
        np.testing.assert_allclose(rotations((a.T @ b)[None])[0], expected, atol=1e-9)
