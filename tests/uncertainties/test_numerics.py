"""The law of propagation and regions, against published examples, closed forms and other packages.

Published: GUM (JCGM 100:2008) G.4.1, table G.2, H.1, H.2; JCGM 102:2011 6.5.
"""

import itertools
import math

import GTC
import numpy as np
import pytest
from scipy import stats

import uncertainties
from ulna.uncertainties.gum import coverage_factor, effective_degrees_of_freedom, numerical_jacobian, propagate
from ulna.uncertainties.regions import contains, coverage_factor_of_region, ellipsoid
from uncertainties import umath

# --- GUM H.2: resistance, reactance and impedance from five sets of V, I, φ -------------------------------------------

#: table H.2: V in V, I in A, φ in rad
H2 = np.array(
    [
        [5.007, 19.663e-3, 1.0456],
        [4.994, 19.639e-3, 1.0438],
        [5.005, 19.640e-3, 1.0468],
        [4.990, 19.685e-3, 1.0428],
        [4.999, 19.678e-3, 1.0433],
    ]
)
MEAN = H2.mean(axis=0)
MEAN_COVARIANCE = np.cov(H2, rowvar=False) / len(H2)


def impedance(x):
    """R, X, Z in Ω (H.2.2)."""
    v, i, phi = x
    return np.array([v / i * np.cos(phi), v / i * np.sin(phi), v / i])


def impedance_jacobian(x):
    v, i, phi = x
    z, c, s = v / i, np.cos(phi), np.sin(phi)
    return np.array([[c / i, -z * c / i, -z * s], [s / i, -z * s / i, z * c], [1 / i, -z / i, 0.0]])


def correlations(covariance):
    u = np.sqrt(np.diag(covariance))
    return (covariance / np.outer(u, u))[np.triu_indices(3, 1)]


def test_the_inputs_of_h2_are_as_printed():
    # table H.2, second part
    assert np.round(MEAN * [1, 1e3, 1], 5) == pytest.approx([4.9990, 19.6610, 1.04446])
    assert np.round(np.sqrt(np.diag(MEAN_COVARIANCE))[:2] * [1, 1e3], 4) == pytest.approx([0.0032, 0.0095])
    assert round(math.sqrt(MEAN_COVARIANCE[2, 2]), 5) == 0.00075
    assert np.round(correlations(MEAN_COVARIANCE), 2) == pytest.approx([-0.36, 0.86, -0.65])


@pytest.mark.parametrize("analytic", [True, False])
def test_h2_by_the_law_of_propagation(analytic):
    # table H.3. It prints u(X) = 0.295, which is what the second way (table H.4) gives; the law of propagation gives
    # 0.2956, here and by the packages below, so X is held to one unit of the last digit
    u = np.sqrt(np.diag(MEAN_COVARIANCE))
    jacobian = impedance_jacobian(MEAN) if analytic else numerical_jacobian(impedance, MEAN, u)
    found = propagate(jacobian, MEAN_COVARIANCE)
    assert np.round(impedance(MEAN), 3) == pytest.approx([127.732, 219.847, 254.260])
    u = np.sqrt(np.diag(found))
    assert np.round(u[[0, 2]], 3) == pytest.approx([0.071, 0.236])
    assert u[1] == pytest.approx(0.295, abs=0.001)
    assert np.round(correlations(found), 3) == pytest.approx([-0.588, -0.485, 0.993])


def test_h2_by_the_sets_one_by_one():
    # table H.4: the second way of evaluating; its figures are those of the first
    each = np.array([impedance(row) for row in H2])
    covariance = np.cov(each, rowvar=False) / len(each)
    first_order = propagate(impedance_jacobian(MEAN), MEAN_COVARIANCE)
    assert np.round(each.mean(axis=0), 3) == pytest.approx([127.732, 219.847, 254.260])
    assert np.round(np.sqrt(np.diag(covariance)), 3) == pytest.approx([0.071, 0.295, 0.236])
    assert np.round(correlations(covariance), 3) == pytest.approx([-0.588, -0.485, 0.993])
    assert np.allclose(first_order, covariance, rtol=1e-2)


def test_h2_agrees_with_other_packages():
    ours = propagate(numerical_jacobian(impedance, MEAN, np.sqrt(np.diag(MEAN_COVARIANCE))), MEAN_COVARIANCE)

    v, i, phi = uncertainties.correlated_values(MEAN, MEAN_COVARIANCE)
    theirs = np.array(uncertainties.covariance_matrix([v / i * umath.cos(phi), v / i * umath.sin(phi), v / i]))
    assert np.allclose(ours, theirs, rtol=1e-6)

    u = np.sqrt(np.diag(MEAN_COVARIANCE))
    inputs = GTC.multiple_ureal(MEAN, u, 4)
    for (j, k), r in zip(itertools.combinations(range(3), 2), correlations(MEAN_COVARIANCE), strict=True):
        GTC.set_correlation(r, inputs[j], inputs[k])
    v, i, phi = inputs
    outputs = [v / i * GTC.cos(phi), v / i * GTC.sin(phi), v / i]
    assert np.sqrt(np.diag(ours)) == pytest.approx([GTC.uncertainty(y) for y in outputs], rel=1e-6)
    theirs = [GTC.get_correlation(a, b) for a, b in itertools.combinations(outputs, 2)]
    assert correlations(ours) == pytest.approx(theirs, abs=1e-6)


def test_propagation_is_symmetric_and_never_negative():
    rng = np.random.default_rng(1)
    root = rng.normal(size=(6, 4))  # a covariance of rank 4
    found = propagate(rng.normal(size=(5, 6)), root @ root.T)
    assert (found == found.T).all()
    assert np.linalg.eigvalsh(found).min() > -1e-12 * np.trace(found)


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-6])
def test_numerical_jacobian_at_every_size_of_u(size):
    found = numerical_jacobian(impedance, MEAN, size * MEAN)
    exact = impedance_jacobian(MEAN)
    assert np.abs(found - exact).max() < 2e-6 * np.abs(exact).max()


def test_numerical_jacobian_of_what_is_known():
    found = numerical_jacobian(impedance, MEAN, np.array([0.003, 0.0, 0.0]))
    assert found[:, 0] == pytest.approx(impedance_jacobian(MEAN)[:, 0])
    assert (found[:, 1:] == 0.0).all()


# --- GUM annex G ------------------------------------------------------------------------------------------------------


def test_effective_degrees_of_freedom_as_printed():
    # G.4.1, example: relative u of 0.25, 0.57, 0.82 % with n = 10, 5, 15 → 19.0
    assert round(effective_degrees_of_freedom(np.array([0.25, 0.57, 0.82]), np.array([9.0, 4.0, 14.0])), 1) == 19.0
    # H.1.6, end gauge: contributions in nm of l_S, d, δα, δθ; truncated to 16
    contributions = np.array([25.0, 9.7, 2.9, 16.6])
    assert math.floor(effective_degrees_of_freedom(contributions, np.array([18.0, 25.6, 50.0, 2.0]))) == 16
    assert round(coverage_factor(0.99, 16), 2) == 2.92  # H.1.6


def test_effective_degrees_of_freedom_at_the_limits():
    one = np.array([1e-100])
    assert effective_degrees_of_freedom(one, np.array([7.0])) == pytest.approx(7.0)
    assert effective_degrees_of_freedom(np.ones(3), np.full(3, 5.0)) == pytest.approx(15.0)
    assert effective_degrees_of_freedom(np.ones(2), np.full(2, np.inf)) == math.inf
    assert effective_degrees_of_freedom(np.zeros(2), np.array([3.0, np.inf])) == math.inf


def test_effective_degrees_of_freedom_agree_with_gtc():
    a, b, c = GTC.ureal(1.0, 0.3, 5), GTC.ureal(2.0, 0.1, 12), GTC.ureal(3.0, 0.2)
    ours = effective_degrees_of_freedom(np.array([0.6, 0.3, 0.2]), np.array([5.0, 12.0, np.inf]))
    assert ours == pytest.approx(GTC.dof(2 * a + 3 * b - c))


@pytest.mark.parametrize(
    ("p", "nu", "printed"),
    [(0.95, 1, 12.71), (0.95, 5, 2.57), (0.95, 10, 2.23), (0.99, 10, 3.17), (0.99, 1, 63.66), (0.95, math.inf, 1.96)],
)
def test_coverage_factors_of_table_g2(p, nu, printed):
    assert round(coverage_factor(p, nu), 2) == printed


def test_coverage_factors_against_scipy():
    assert coverage_factor(0.9, 7.3) == pytest.approx(stats.t.ppf(0.95, 7.3))
    assert coverage_factor(0.9973) == pytest.approx(stats.norm.ppf(0.99865))


# --- regions, JCGM 102 6.5 --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("m", "printed"), [(2, 2.45), (3, 2.80), (4, 3.08), (5, 3.33)])
def test_coverage_factors_of_regions(m, printed):
    # JCGM 102 6.5, p = 0.95
    assert round(coverage_factor_of_region(0.95, m), 2) == printed


@pytest.mark.parametrize(
    ("p", "m", "chi2"), [(0.95, 1, 3.841), (0.95, 2, 5.991), (0.95, 3, 7.815), (0.99, 1, 6.635), (0.99, 3, 11.345)]
)
def test_coverage_factors_against_tables_of_chi_squared(p, m, chi2):
    assert round(coverage_factor_of_region(p, m) ** 2, 3) == chi2
    assert coverage_factor_of_region(p, 1) == pytest.approx(coverage_factor(p))


def test_the_ellipsoid_of_a_known_covariance():
    # turned about z by 30°: standard uncertainties 3, 2, 1 along its axes
    c, s = math.cos(math.pi / 6), 0.5
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    found = ellipsoid(np.array([1.0, 2.0, 3.0]), turn @ np.diag([4.0, 9.0, 1.0]) @ turn.T)
    assert found.half_lengths == pytest.approx(found.k * np.array([3.0, 2.0, 1.0]))
    assert np.abs(found.axes @ turn) == pytest.approx(np.eye(3)[[1, 0, 2]], abs=1e-12)
    ends = found.centre + found.half_lengths[:, None] * found.axes
    assert contains(found, found.centre + 0.999 * (ends - found.centre)).all()
    assert not contains(found, found.centre + 1.001 * (ends - found.centre)).any()


@pytest.mark.parametrize("p", [0.5, 0.95, 0.99])
def test_the_ellipsoid_covers_as_often_as_it_says(p):
    rng = np.random.default_rng(6)
    root = rng.normal(size=(3, 3)) * [1.0, 1e-2, 1e3]
    y = np.array([100.0, -5.0, 7.0])
    region = ellipsoid(y, root @ root.T, p)
    inside = contains(region, y + rng.normal(size=(100_000, 3)) @ root.T).sum()
    low, high = stats.binom.ppf([0.0005, 0.9995], 100_000, p)
    assert low <= inside <= high


def test_an_ellipsoid_flat_along_what_is_known():
    region = ellipsoid(np.zeros(3), np.diag([1.0, 0.0, 1.0]))
    assert region.half_lengths[2] == 0.0
    assert list(contains(region, np.array([[2.0, 0.0, 1.0], [2.0, 1e-9, 1.0], [3.0, 0.0, 1.0]]))) == [
        True,
        False,
        False,
    ]
