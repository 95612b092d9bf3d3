"""Quantiles of ours, against those of SciPy, tables of mpmath and what must hold of them."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import special, stats

from ulna.ground.quantiles import chi_squared, chi_squared_beyond, fisher, fisher_beyond, normal, normals, student

FREEDOM = np.array([0.05, 0.3, 0.5, 1, 1.5, 2, 3, 4.7, 10, 33.3, 100, 400, 999, 1000, 1001, 5000, 1e5, 1e9, 1e14])
PROBABILITIES = [0.001, 0.025, 0.5, 0.6, 0.9, 0.975, 0.99865, 0.9999]


@pytest.mark.parametrize("p", PROBABILITIES)
def test_student_is_that_of_scipy(p):
    np.testing.assert_allclose(student(FREEDOM, p), special.stdtrit(FREEDOM, p), rtol=1e-11, atol=1e-15)


@pytest.mark.parametrize("p", PROBABILITIES)
def test_normal_is_that_of_scipy(p):
    assert normal(p) == pytest.approx(special.ndtri(p), rel=1e-14, abs=1e-15)
    assert normals(np.array([p, 0.7])).tolist() == [normal(p), normal(0.7)]


@pytest.mark.parametrize("p", [0.01, 0.5, 0.95, 0.9999])
@pytest.mark.parametrize("freedom", [1, 2, 3, 6, 25, 200, 5000])
def test_chi_squared_is_that_of_scipy(freedom, p):
    assert chi_squared(freedom, p) == pytest.approx(special.chdtri(freedom, 1.0 - p), rel=1e-9)


@pytest.mark.parametrize("p", [0.5, 0.95, 0.9999])
@pytest.mark.parametrize("denominator", [0.7, 1, 2, 5, 30, 1000, 1e5])
@pytest.mark.parametrize("numerator", [1, 2, 3, 7, 25, 60])
def test_fisher_is_that_of_scipy(numerator, denominator, p):
    assert fisher(numerator, denominator, p) == pytest.approx(special.fdtri(numerator, denominator, p), rel=1e-9)


@given(st.floats(0.2, 3000.0), st.floats(0.51, 0.9999))
def test_student_stays_below_as_often_as_said(freedom, p):
    """The distribution function by mpmath, which computes it another way and to thirty digits."""
    with mpmath.workdps(30):
        t, v = mpmath.mpf(float(student(freedom, p))), mpmath.mpf(freedom)
        above = mpmath.betainc(v / 2, mpmath.mpf(1) / 2, 0, v / (v + t**2), regularized=True) / 2
    assert float(above) == pytest.approx(1.0 - p, rel=1e-9)


def test_one_square_of_student_is_fisher():
    for freedom in (0.7, 4.0, 60.0):
        assert fisher(1, freedom, 0.95) == pytest.approx(float(student(freedom, 0.975)) ** 2, rel=1e-11)
    assert chi_squared(1, 0.95) == pytest.approx(normal(0.975) ** 2, rel=1e-11)


def test_shapes_and_no_degrees_of_freedom():
    assert student(3.0, 0.975).shape == ()
    assert student(np.zeros((0,)), 0.975).shape == (0,)
    assert student(np.ones((2, 3)), 0.975).shape == (2, 3)
    assert math.isnan(float(student(0.0, 0.975)))
    assert math.isnan(fisher(3, 0.0, 0.95))
    assert student(np.array([0.0, 5.0]), 0.975)[1] == student(5.0, 0.975)


@pytest.mark.parametrize("freedom", [1, 2, 3, 7, 25, 26, 120])
@pytest.mark.parametrize("value", [0.0, 0.3, 5.0, 24.7, 80.0, 2038.9])
def test_how_often_chi_squared_is_beyond_is_that_of_scipy(freedom, value):
    assert chi_squared_beyond(freedom, value) == pytest.approx(stats.chi2.sf(value, freedom), rel=1e-10, abs=1e-300)


@pytest.mark.parametrize(("numerator", "denominator"), [(1, 3), (25, 76.3), (25, 4.2), (7, 1e5)])
@pytest.mark.parametrize("value", [0.0, 0.2, 1.0, 3.5, 80.0])
def test_how_often_fisher_is_beyond_is_that_of_scipy(numerator, denominator, value):
    found = fisher_beyond(numerator, denominator, value)
    assert found == pytest.approx(stats.f.sf(value, numerator, denominator), rel=1e-8, abs=1e-300)
