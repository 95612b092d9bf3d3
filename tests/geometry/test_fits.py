"""Fits against independent solvers (SciPy), closed forms and the laws of rigid motion and scale.

NIST's reference data (Shakarji 1998) come with no package that could be found, so SciPy's trust-region least squares
from the true start is the oracle.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize
from scipy.spatial.transform import Rotation

from ulna.geometry.circle import fit_circle
from ulna.geometry.enclosing import enclosing_sphere
from ulna.geometry.line import fit_line
from ulna.geometry.plane import fit_plane
from ulna.geometry.sphere import fit_sphere
from ulna.ground.errors import UlnaInputError

F64 = NDArray[np.float64]

AT = np.array([612.0, -843.0, 377.0])


def cap(count: int, half_angle_deg: float, noise_mm: float, seed: int, radius_mm: float = 12.5) -> F64:
    """Points on the top of a ball at AT, within so many degrees of its pole."""
    rng = np.random.default_rng(seed)
    z = rng.uniform(np.cos(np.radians(half_angle_deg)), 1.0, count)
    turn, beside = rng.uniform(0.0, 2.0 * np.pi, count), np.sqrt(1.0 - z**2)
    on = np.column_stack([beside * np.cos(turn), beside * np.sin(turn), z])
    return np.asarray((radius_mm + noise_mm * rng.standard_normal((count, 1))) * on + AT)


def scipy_sphere(points: F64, start: F64) -> F64:
    middle = points.mean(axis=0)

    def away(state: F64) -> F64:
        return np.asarray(np.linalg.norm(points - middle - state[:3], axis=1) - state[3])

    def slopes(state: F64) -> F64:
        at = points - middle - state[:3]
        return np.column_stack([-at / np.linalg.norm(at, axis=1, keepdims=True), -np.ones(len(at))])

    first = np.r_[start[:3] - middle, start[3]]
    found = least_squares(away, first, slopes, x_scale="jac", xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=3000)
    return np.r_[found.x[:3] + middle, found.x[3], 2.0 * found.cost]


@pytest.mark.parametrize(
    ("count", "half_angle", "noise", "within"),
    [
        (25, 90, 0.01, 1e-8),
        (5, 90, 0.01, 1e-8),
        (4, 60, 0.01, 1e-7),
        (25, 10, 0.003, 1e-7),
        (25, 3, 1e-4, 1e-5),
        (200, 1, 1e-5, 1e-4),
        (100_000, 90, 0.01, 1e-8),
    ],
)
def test_sphere_against_scipy(count: int, half_angle: float, noise: float, within: float) -> None:
    points = cap(count, half_angle, noise, seed=count)
    found = fit_sphere(points)
    *expected, squares = scipy_sphere(points, np.r_[AT, 12.5])
    assert np.r_[found.centre_mm, found.radius_mm] == pytest.approx(np.array(expected), abs=within)
    assert float((found.residuals_mm**2).sum()) <= squares * (1.0 + 1e-9) + 1e-20
    assert found.form_mm == pytest.approx(np.ptp(np.linalg.norm(points - found.centre_mm, axis=1)), abs=1e-10)


@pytest.mark.parametrize("half_angle", [90, 30, 5, 1, 0.2])
def test_exact_points_give_the_ball_back(half_angle: float) -> None:
    """Rounding of the coordinates, 1e-13 mm, grows by the square of the cap's flatness and no more."""
    found = fit_sphere(cap(30, half_angle, 0.0, seed=1))
    lost = 1e-12 * (90.0 / half_angle) ** 2
    assert found.radius_mm == pytest.approx(12.5, abs=10 * lost)
    assert found.centre_mm == pytest.approx(AT, abs=10 * lost)


def test_an_outlier_pulls_as_least_squares_says() -> None:
    points = cap(25, 90, 0.005, seed=4)
    points[7] += [0.0, 0.0, 3.0]
    points[19] += [1.5, -2.0, 0.0]
    found = fit_sphere(points)
    *expected, _ = scipy_sphere(points, np.r_[AT, 12.5])
    assert np.r_[found.centre_mm, found.radius_mm] == pytest.approx(np.array(expected), abs=1e-6)


def test_many_sets_are_fitted_as_each_alone() -> None:
    sets = np.stack([cap(9, 70, 0.02, seed) for seed in range(12)]).reshape(3, 4, 9, 3)
    found = fit_sphere(sets)
    assert found.centre_mm.shape == (3, 4, 3)
    assert found.residuals_mm.shape == (3, 4, 9)
    for i in range(3):
        for j in range(4):
            assert found.radius_mm[i, j] == pytest.approx(float(fit_sphere(sets[i, j]).radius_mm), abs=1e-11)


def test_octahedron_and_its_shifted_pole_in_closed_form() -> None:
    """Six points at distance 1, two opposite ones at 1 + e: the fitted radius is 1 + e/3 and the centre stays."""
    points = np.concatenate([np.eye(3), -np.eye(3)])
    points[[2, 5], 2] *= 1.03
    found = fit_sphere(points)
    assert found.radius_mm == pytest.approx(1.01, abs=1e-13)
    assert found.centre_mm == pytest.approx(np.zeros(3), abs=1e-13)
    assert found.form_mm == pytest.approx(0.03, abs=1e-13)


def plane_points(count: int, noise: float, seed: int) -> F64:
    rng = np.random.default_rng(seed)
    flat = np.column_stack([rng.uniform(-60, 60, (count, 2)), noise * rng.standard_normal(count)])
    return np.asarray(flat @ Rotation.from_rotvec([0.3, -0.5, 0.2]).as_matrix() + AT)


@pytest.mark.parametrize("count", [5, 40, 100_000])
def test_plane_against_scipy(count: int) -> None:
    points = plane_points(count, 0.02, seed=count)
    found = fit_plane(points)
    middle = points.mean(axis=0)
    at = points - middle

    def height(x: F64) -> F64:
        return np.asarray((at @ np.array([-x[0], -x[1], 1.0]) - x[2]) / np.sqrt(1.0 + x[0] ** 2 + x[1] ** 2))

    beta = least_squares(height, np.zeros(3), xtol=1e-15, ftol=1e-15, gtol=1e-15).x
    normal = np.array([-beta[0], -beta[1], 1.0]) / np.sqrt(1.0 + beta[0] ** 2 + beta[1] ** 2)
    assert abs(float(normal @ found.normal)) == pytest.approx(1.0, abs=1e-10)
    assert found.residuals_mm == pytest.approx((points - middle) @ found.normal, abs=1e-9)
    assert float(found.normal @ found.point_mm) < 0.0, "towards the origin"
    assert float(found.distance_mm(np.zeros(3))) > 0.0


def test_plane_and_line_in_closed_form() -> None:
    """A unit square with corners ±h out of plane in turn: least-squares plane z = 0, form 2h."""
    square = np.array([[1, 1, 0.1], [-1, 1, -0.1], [-1, -1, 0.1], [1, -1, -0.1]])
    plane = fit_plane(np.add(square, [0, 0, 5]))
    assert plane.normal == pytest.approx([0, 0, -1], abs=1e-12)
    assert plane.form_mm == pytest.approx(0.2, abs=1e-12)
    line = fit_line(np.array([[0, 0.1, 0], [1, -0.1, 0], [2, -0.1, 0], [3, 0.1, 0]]))
    assert line.direction == pytest.approx([1, 0, 0], abs=1e-12)
    assert line.form_mm == pytest.approx(0.2, abs=1e-12)


def test_line_is_where_the_squares_are_least() -> None:
    rng = np.random.default_rng(5)
    points = np.outer(rng.uniform(-200, 200, 50), [0.6, 0.0, 0.8]) + 0.05 * rng.standard_normal((50, 3)) + AT
    found = fit_line(points)

    def squares(x: F64) -> float:
        direction = np.array([x[0], x[1], 1.0]) / np.sqrt(x[0] ** 2 + x[1] ** 2 + 1.0)
        away = points - AT - [x[2], x[3], 0.0]
        return float((away**2).sum() - ((away @ direction) ** 2).sum())

    best = minimize(squares, [0.75, 0.0, 0.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert float((found.residuals_mm**2).sum()) <= best.fun * (1 + 1e-9)


@pytest.mark.parametrize(("count", "arc_deg", "noise"), [(8, 360, 0.02), (5, 200, 0.02), (30, 40, 0.002)])
def test_circle_against_scipy(count: int, arc_deg: float, noise: float) -> None:
    rng = np.random.default_rng(count)
    turn = np.radians(np.linspace(0.0, arc_deg, count, endpoint=False))
    flat = np.column_stack([40 * np.cos(turn), 40 * np.sin(turn), np.zeros(count)])
    points = (flat + noise * rng.standard_normal((count, 3))) @ Rotation.from_rotvec([0.4, 0.1, -0.9]).as_matrix() + AT
    found = fit_circle(points)

    def away(x: F64) -> F64:
        normal = x[3:6] / np.linalg.norm(x[3:6])
        at = points - AT - x[:3]
        height = at @ normal
        return np.r_[np.linalg.norm(at - np.outer(height, normal), axis=1) - x[6], height]

    start = np.r_[found.centre_mm - AT + 0.5, found.normal + 0.05, found.radius_mm - 0.3]
    best = least_squares(away, start, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=5000)
    ours = float((found.residuals_mm**2).sum() + (found.heights_mm**2).sum())
    assert ours == pytest.approx(2.0 * best.cost, rel=1e-6)
    assert found.radius_mm == pytest.approx(best.x[6], abs=1e-4)


def brute(points: F64) -> float:
    """Radius of the smallest enclosing sphere, by SciPy: min t with ‖p - c‖ ≤ t, from several starts of a solver."""
    found = minimize(
        lambda x: x[3],
        np.r_[points.mean(axis=0), 2.0 * np.linalg.norm(points - points.mean(axis=0), axis=1).max()],
        constraints={"type": "ineq", "fun": lambda x: x[3] - np.linalg.norm(points - x[:3], axis=1)},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    return float(found.x[3])


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6, 8, 30, 300])
def test_enclosing_sphere_against_a_solver(count: int) -> None:
    for seed in range(5):
        points = np.random.default_rng([count, seed]).standard_normal((count, 3))
        found = enclosing_sphere(points)
        assert np.linalg.norm(points - found.centre_mm, axis=1).max() <= found.radius_mm * (1 + 1e-13)
        assert found.radius_mm == pytest.approx(brute(points), rel=1e-6)


def test_enclosing_spheres_in_closed_form() -> None:
    """Pair: half the distance. Regular triangle of side a: a/√3. Cube: a√3/2. Obtuse: the long side."""
    cube = np.array([[x, y, z] for x in (0, 2) for y in (0, 2) for z in (0, 2)], dtype=float)
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0.5, np.sqrt(3) / 2, 0]])
    obtuse = np.array([[0, 0, 0], [10, 0, 0], [5, 1, 0], [5, 0, -0.5]])
    assert enclosing_sphere(AT[None]).diameter_mm == 0.0
    assert enclosing_sphere(np.stack([AT, AT, AT])).diameter_mm == 0.0
    assert enclosing_sphere(np.add(AT, [[0, 0, 0], [3, 4, 0]])).diameter_mm == pytest.approx(5.0, abs=1e-12)
    assert enclosing_sphere(triangle).radius_mm == pytest.approx(1 / np.sqrt(3), abs=1e-14)
    assert enclosing_sphere(cube).radius_mm == pytest.approx(np.sqrt(3), abs=1e-14)
    assert enclosing_sphere(obtuse).centre_mm == pytest.approx([5, 0, 0], abs=1e-12)


def test_enclosing_sphere_of_very_many_and_of_equal_points() -> None:
    points = np.random.default_rng(3).standard_normal((100_000, 3))
    found = enclosing_sphere(points)
    on = np.flatnonzero(np.linalg.norm(points - found.centre_mm, axis=1) > found.radius_mm * (1 - 1e-9))
    assert 2 <= len(on) <= 4
    assert found.radius_mm == pytest.approx(
        min(float(enclosing_sphere(points[list(some)]).radius_mm) for some in combinations(on.tolist(), len(on))),
        rel=1e-12,
    )
    doubled = enclosing_sphere(np.concatenate([points[:40], points[:40]]))
    assert doubled.radius_mm == pytest.approx(float(enclosing_sphere(points[:40]).radius_mm), rel=1e-12)


rigid = st.tuples(*(st.floats(-3.0, 3.0) for _ in range(3)), *(st.floats(-2000.0, 2000.0) for _ in range(3)))


@settings(max_examples=40, deadline=None)
@given(motion=rigid, scale=st.floats(1e-3, 1e3), seed=st.integers(0, 1000))
def test_motion_changes_nothing_and_scale_scales(motion: tuple[float, ...], scale: float, seed: int) -> None:
    points = np.random.default_rng(seed).uniform(-10, 10, (9, 3))
    turn = Rotation.from_rotvec(motion[:3]).as_matrix()
    moved = scale * points @ turn.T + motion[3:]
    within = {"rel": 1e-6, "abs": 1e-9 * max(scale, 1.0) + 1e-9}
    for of in (
        lambda p: fit_sphere(cap_like(p)).radius_mm,
        lambda p: fit_plane(p).form_mm,
        lambda p: fit_line(p).form_mm,
        lambda p: enclosing_sphere(p).radius_mm,
    ):
        assert float(of(moved)) == pytest.approx(scale * float(of(points)), **within)
    assert enclosing_sphere(moved).centre_mm == pytest.approx(
        scale * enclosing_sphere(points).centre_mm @ turn.T + motion[3:], rel=1e-6, abs=1e-6 * scale + 1e-8
    )


def cap_like(points: F64) -> F64:
    """The points drawn near a sphere about their mean, so that one is nearest."""
    middle = points.mean(axis=0)
    away = points - middle
    distance = np.linalg.norm(away, axis=1, keepdims=True)
    mean = distance.mean()
    return np.asarray(middle + away / distance * (0.9 * mean + 0.1 * distance))


@pytest.mark.parametrize(
    ("fit", "points", "told"),
    [
        (fit_sphere, np.zeros((3, 3)), "3 points; expected 4"),
        (fit_sphere, np.zeros((5, 3)), "on a plane"),
        (fit_sphere, plane_points(12, 0.0, 1), "on a plane"),
        (fit_sphere, np.full((5, 3), np.nan), "not a finite number"),
        (fit_plane, np.zeros((2, 3)), "2 points; expected 3"),
        (fit_plane, np.outer(np.arange(5.0), [1, 2, 3]) + AT, "on a line"),
        (fit_circle, np.outer(np.arange(5.0), [1, 2, 3]) + AT, "on a line"),
        (fit_line, np.ones((4, 3)), "one and the same"),
        (enclosing_sphere, np.zeros((0, 3)), "0 points; expected 1"),
    ],
)
def test_what_determines_nothing_is_told(fit, points, told) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(UlnaInputError, match=told):
        fit(points)


def test_the_set_that_fails_is_named() -> None:
    sets = np.stack([cap(6, 90, 0.01, 1), plane_points(6, 0.0, 2), cap(6, 90, 0.01, 3)])
    with pytest.raises(UlnaInputError, match="set 2 of 3: the 6 points are on a plane: rms extents"):
        fit_sphere(sets)
