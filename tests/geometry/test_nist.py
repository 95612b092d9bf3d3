"""Least-squares fits against NIST's reference pairs of its Algorithm Testing System (ASME B89.4.10): 30 spheres, 30
planes, 30 cylinders. Points are given to five decimals, the reference fits of those very points to twenty digits.

The data are a work of the US government; `crates/ulna/tests/nist/pairs.rs` says where they come from."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ulna.geometry.cylinder import fit_cylinder
from ulna.geometry.plane import fit_plane
from ulna.geometry.sphere import fit_sphere

PAIRS = range(1, 31)
#: a hundredth of NIST's own 1e-6 mm for its grades, and hundreds of times above what is reached
NEAR_MM, NEAR_RAD = 1e-8, 1e-8


@cache
def pairs(file: Path) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Name → points (N, 3), and the numbers of the reference fit: the pairs that the core is tested with too."""
    lines, found = file.read_text(encoding="ascii").splitlines(), {}
    while lines:
        name, count, *fit = lines[0].split()
        points = np.loadtxt(lines[1 : 1 + int(count)])
        assert len(points) == int(count)
        found[name] = points, np.array(fit, dtype=np.float64)
        lines = lines[1 + int(count) :]
    assert len(found) == len(PAIRS), f"{file} holds other pairs than it did"
    return found


def pair(root: Path, shape: str, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (N, 3), and the numbers of the reference fit."""
    return pairs(root / "crates" / "ulna" / "tests" / "data" / f"nist_{shape.lower()}.txt")[name]


def apart_rad(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """The angle between two lines, small ones exactly."""
    return float(np.linalg.norm(np.cross(one, other)) / np.linalg.norm(one) / np.linalg.norm(other))


@pytest.mark.parametrize("number", PAIRS)
def test_spheres(root: Path, number: int) -> None:
    points, reference = pair(root, "Sphere", f"sph{number}")
    sphere = fit_sphere(points)
    assert np.linalg.norm(sphere.centre_mm - reference[:3]) < NEAR_MM
    assert abs(2.0 * sphere.radius_mm - reference[3]) < NEAR_MM


@pytest.mark.parametrize("number", PAIRS)
def test_planes(root: Path, number: int) -> None:
    points, reference = pair(root, "Plane", f"pla{number}")
    plane = fit_plane(points)
    assert apart_rad(plane.normal, reference[3:]) < NEAR_RAD
    assert abs((plane.point_mm - reference[:3]) @ plane.normal) < NEAR_MM


@pytest.mark.parametrize("number", PAIRS)
def test_cylinders(root: Path, number: int) -> None:
    points, reference = pair(root, "Cylinder", f"cyl{number}")
    cylinder = fit_cylinder(points)
    axis = reference[3:6] / np.linalg.norm(reference[3:6])
    assert apart_rad(cylinder.direction, axis) < NEAR_RAD
    assert np.linalg.norm(np.cross(cylinder.point_mm - reference[:3], axis)) < NEAR_MM
    assert abs(2.0 * cylinder.radius_mm - reference[6]) < NEAR_MM


def test_a_cylinder_of_many_sets_is_each_one_fitted() -> None:
    """Balls of two sizes around cylinders in any pose: exact, all at once."""
    rng = np.random.default_rng(7)
    sets, count = 50, 12
    angle, along = rng.uniform(0.0, 4.0, (2, sets, count))
    offset = np.where(np.arange(count) % 2, 1.5, 3.0)
    radius = rng.uniform(5.0, 50.0, (sets, 1)) + offset
    own = np.stack([radius * np.cos(angle), radius * np.sin(angle), 20.0 * along], axis=2)
    turn = np.linalg.qr(rng.standard_normal((sets, 3, 3)))[0]
    found = fit_cylinder(own @ turn + rng.uniform(-500.0, 500.0, (sets, 1, 3)), offsets_mm=offset)
    assert np.abs(found.radius_mm - (radius - offset)[:, 0]).max() < 1e-8
    assert np.abs(np.abs((found.direction * turn[:, 2]).sum(axis=1)) - 1.0).max() < 1e-12
    assert found.form_mm.max() < 1e-8
