"""Least-squares spheres and planes: against SciPy's own minimiser, closed forms, and laws."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from ulna.geometry import planes, spheres


def cap(seed: int, count: int, half_angle_rad: float, noise_mm: float) -> np.ndarray:
    """Points on a ball of 15 mm radius about (300, -200, 500), within an angle of its pole."""
    rng = np.random.default_rng(seed)
    height = rng.uniform(np.cos(half_angle_rad), 1.0, count)
    turn = rng.uniform(0, 2 * np.pi, count)
    across = np.sqrt(1.0 - height**2)
    direction = np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
    return np.array([300.0, -200.0, 500.0]) + 15.0 * direction + noise_mm * rng.standard_normal((count, 3))


@pytest.mark.parametrize(
    ("count", "half_angle_rad", "noise_mm"),
    [(25, np.pi / 2, 0.01), (5, np.pi / 2, 0.01), (40, 0.2, 0.001), (2000, np.pi, 0.5)],
)
def test_spheres_are_those_of_scipy(count: int, half_angle_rad: float, noise_mm: float) -> None:
    points = cap(1, count, half_angle_rad, noise_mm)

    def off(x: np.ndarray) -> np.ndarray:
        return np.linalg.norm(points - x[:3], axis=1) - x[3]

    start = [*points.mean(axis=0) - [0, 0, 10], 14.0]
    by_scipy = least_squares(off, start, xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale="jac")
    found = spheres(points)
    spread = 1e-9 + 1e-6 * noise_mm / (1 - np.cos(half_angle_rad))
    assert found.centre_mm == pytest.approx(by_scipy.x[:3], abs=spread)
    assert found.radius_mm == pytest.approx(by_scipy.x[3], abs=spread)
    assert (found.residuals_mm**2).sum() <= 2 * by_scipy.cost * (1 + 1e-9)
    assert found.form_mm == pytest.approx(np.ptp(off(by_scipy.x)), abs=spread)


def test_exact_points_give_the_ball_back() -> None:
    for count, angle in ((4, np.pi), (100_000, np.pi / 2), (1000, 0.05)):
        found = spheres(cap(2, count, angle, 0.0))
        # a cap of 0.05 rad is 0.02 mm high: rounding of 1e-13 mm grows by the square of 1 / 0.05
        assert found.radius_mm == pytest.approx(15.0, abs=1e-8)
        assert found.form_mm < 1e-9


def test_many_sets_at_once_are_each_by_itself() -> None:
    sets = np.stack([[cap(3 * i + j, 12, 1.5, 0.02) for j in range(3)] for i in range(2)])
    found, flat = spheres(sets), planes(sets)
    assert found.centre_mm.shape == (2, 3, 3)
    assert found.residuals_mm.shape == (2, 3, 12)
    for i in range(2):
        for j in range(3):
            assert found.radius_mm[i, j] == pytest.approx(float(spheres(sets[i, j]).radius_mm), abs=1e-9)
            assert flat.form_mm[i, j] == pytest.approx(float(planes(sets[i, j]).form_mm), abs=1e-12)


def test_a_plane_has_the_least_squares_of_all() -> None:
    rng = np.random.default_rng(4)
    points = np.array([0.0, 0.0, 300.0]) + rng.uniform(-50, 50, (30, 3)) * [1, 1, 0.001]
    found = planes(points)

    def off(x: np.ndarray) -> np.ndarray:
        normal = np.array([np.sin(x[0]), np.sin(x[1]), 1.0])
        return (points @ normal - x[2]) / np.linalg.norm(normal)

    by_scipy = least_squares(off, [0.0, 0.0, 300.0], xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=[1e-3, 1e-3, 1.0])
    assert (found.residuals_mm**2).sum() == pytest.approx(2 * by_scipy.cost, rel=1e-9)
    assert found.form_mm == pytest.approx(np.ptp(off(by_scipy.x)), rel=1e-6)
    assert found.normal[2] > 0  # away from the base


def test_a_flat_square_with_two_corners_up_by_hand() -> None:
    # opposite corners up by h: the best plane is level at h / 2, the form is h
    square = np.array([[0.0, 0.0, 7.1], [10.0, 0.0, 7.0], [10.0, 10.0, 7.1], [0.0, 10.0, 7.0]])
    found = planes(square)
    assert found.normal == pytest.approx([0.0, 0.0, 1.0])
    assert found.middle_mm == pytest.approx([5.0, 5.0, 7.05])
    assert found.form_mm == pytest.approx(0.1)


@settings(max_examples=40, deadline=None)
@given(
    turn=st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3),
    shift=st.lists(st.floats(-500.0, 500.0), min_size=3, max_size=3),
    grows=st.floats(0.5, 20.0),
)
def test_motion_changes_no_shape_and_scale_scales(turn: list[float], shift: list[float], grows: float) -> None:
    points = cap(5, 20, 1.2, 0.05)
    moved = grows * Rotation.from_rotvec(turn).apply(points) + shift
    before, after = spheres(points), spheres(moved)
    assert after.radius_mm == pytest.approx(grows * before.radius_mm, rel=1e-9)
    assert after.form_mm == pytest.approx(grows * before.form_mm, rel=1e-6)
    assert planes(moved).form_mm == pytest.approx(grows * planes(points).form_mm, rel=1e-6)
    # planes have a side: that of the base
    assert np.abs(planes(moved).normal @ Rotation.from_rotvec(turn).apply(planes(points).normal)) == pytest.approx(1.0)
