"""Honesty: the 95 % intervals of each determinable parameter hold the truth as often as they say."""

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.core import core_arm, core_problem, nothing_held
from tests.oracle.observed import Lengths
from tests.oracle.published import table_4

import ulna._core as _core

RUNS = 1000
ENCODER_RAD, SEAT_MM = 5e-6, 0.008
STATED = fits.Noise(np.full(7, ENCODER_RAD), SEAT_MM)
DETERMINED = np.setdiff1d(np.arange(27), [0, 3])
NORMAL_95 = 1.959963984540054

# 1000 runs, 25 parameters: a true 95 % scatters by 0.7 % per parameter, so 93 to 97 % is three sigma for each.
LOW, HIGH = 0.93, 0.97


def exact_bars(truth, count):
    bar = virtual.bars(truth, np.random.default_rng(443), count, 443.172)
    return bar, Lengths(bar.q_rad[0::2], bar.q_rad[1::2], np.full(count, 443.172))


def inside(parameters, u, truth):
    return (abs(parameters - truth.parameters) < NORMAL_95 * u)[:, DETERMINED].mean(axis=0)


@pytest.mark.slow
def test_intervals_from_noise_drawn_by_the_oracle():
    """1000 calibrations with 101 lengths; noise drawn here: tips beside the seat, encoders beside the pose."""
    truth = table_4()
    _, rows = exact_bars(truth, 101)
    start = virtual.wrong_start(truth, np.random.default_rng(1), 0.01, 2.0)
    rng = np.random.default_rng(2026)

    # Micrometres beside the seat: one step of the poses is enough, and its matrix is the same in every run.
    follow = {end: np.linalg.pinv(truth.encoder_jacobian(q)) for end, q in (("A", rows.q_rad), ("B", rows.p_rad))}

    def touched(end, q):
        seat = SEAT_MM * rng.standard_normal((len(q), 3))
        return q + np.einsum("nij,nj->ni", follow[end], seat) + ENCODER_RAD * rng.standard_normal(q.shape)

    parameters, u = np.empty((RUNS, 27)), np.empty((RUNS, 27))
    chi2 = np.empty(RUNS)
    for run in range(RUNS):
        noisy = Lengths(touched("A", rows.q_rad), touched("B", rows.p_rad), rows.length_mm)
        found = _core.fit(core_problem(start, [noisy], STATED), nothing_held(truth))
        assert found.converged
        parameters[run] = found.parameters
        u[run] = np.sqrt(np.diag(found.covariance))
        chi2[run] = found.chi2_per_dof
    coverage = inside(parameters, u, truth)
    assert (coverage >= LOW).all(), coverage
    assert (coverage <= HIGH).all(), coverage
    # Chi squared of 76 degrees of freedom: mean one, within four standard errors.
    assert chi2.mean() == pytest.approx(1.0, abs=4 * np.sqrt(2 / 76 / RUNS))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["lengths", "bar touched twice"])
def test_intervals_from_noise_drawn_by_the_core(kind):
    """The same by `recalibrate`, which later work stands on; also with placements to eliminate."""
    truth = table_4()
    if kind == "lengths":
        groups = [exact_bars(truth, 101)[1]]
    else:
        groups = [virtual.bars(truth, np.random.default_rng(7), 40, 443.172, each=2)]
    problem = core_problem(truth, groups, STATED)
    runs = 3 * RUNS  # they are cheap, and the limits are then five standard errors away
    parameters, u, converged = _core.recalibrate(problem, nothing_held(truth), core_arm(truth), runs, seed=1, threads=2)
    assert parameters.shape == u.shape == (runs, 27)
    assert converged.all()
    assert np.isnan(u[:, [0, 3]]).all()
    np.testing.assert_array_equal(parameters[:, [0, 3]], np.broadcast_to(truth.parameters[[0, 3]], (runs, 2)))
    coverage = inside(parameters, u, truth)
    assert (coverage >= LOW).all(), coverage
    assert (coverage <= HIGH).all(), coverage
    # The scatter of the estimates is what each run stated.
    scatter = parameters[:, DETERMINED].std(axis=0) / np.sqrt((u[:, DETERMINED] ** 2).mean(axis=0))
    assert abs(scatter - 1).max() < 4.5 / np.sqrt(2 * runs)


def test_a_bar_touched_once_at_each_end_is_calibrated_by_its_lengths():
    """The bar is its length rows, but for the millionth of a touch's variance that keeps its weight finite; what each
    run states, and how they scatter, is what one fit says."""
    truth = table_4()
    bar, rows = exact_bars(truth, 101)
    placed = core_problem(truth, [bar], STATED)
    runs = 400
    found = _core.recalibrate(placed, nothing_held(truth), core_arm(truth), runs, seed=1, threads=2)
    lengths = _core.recalibrate(
        core_problem(truth, [rows], STATED), nothing_held(truth), core_arm(truth), runs, seed=1, threads=2
    )
    (parameters, u, converged), (others, their_u, they_converged) = found, lengths
    assert abs((parameters - others) / their_u)[:, DETERMINED].max() < 1e-5
    np.testing.assert_allclose(u, their_u, rtol=2e-6)
    np.testing.assert_array_equal(converged, they_converged)
    stated = np.sqrt(np.diag(_core.fit(placed, nothing_held(truth)).covariance))[DETERMINED]
    np.testing.assert_allclose(np.sqrt((found[1][:, DETERMINED] ** 2).mean(axis=0)), stated, rtol=2e-3)
    scatter = found[0][:, DETERMINED].std(axis=0) / stated
    assert abs(scatter - 1).max() < 4.5 / np.sqrt(2 * runs)


def test_recalibrations_do_not_depend_on_threads():
    truth = table_4()
    problem = core_problem(truth, [exact_bars(truth, 60)[1]], STATED)
    one = _core.recalibrate(problem, nothing_held(truth), core_arm(truth), 40, seed=9, threads=1)
    two = _core.recalibrate(problem, nothing_held(truth), core_arm(truth), 40, seed=9, threads=2)
    other = _core.recalibrate(problem, nothing_held(truth), core_arm(truth), 40, seed=10, threads=2)
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a, b)
    assert abs(one[0] - other[0])[:, DETERMINED].min() > 0


@pytest.mark.slow
def test_intervals_without_stated_noise():
    """Nothing stated: the residuals give the scale. Equal weights are right for the noise drawn here."""
    truth = table_4()
    _, rows = exact_bars(truth, 101)
    rng = np.random.default_rng(5)
    hits, runs = np.zeros(len(DETERMINED)), 600
    for _ in range(runs):
        noisy = Lengths(rows.q_rad, rows.p_rad, rows.length_mm + 0.01 * rng.standard_normal(101))
        found = _core.fit(core_problem(truth, [noisy]), nothing_held(truth))
        u = np.sqrt(np.diag(found.covariance))
        # 76 degrees of freedom: Student's 95 % factor is 1.9917.
        hits += (abs(found.parameters - truth.parameters) < 1.9917 * u)[DETERMINED]
    assert (hits / runs >= 0.92).all()
    assert (hits / runs <= 0.98).all()


def test_fresh_bars_after_the_virtual_experiment():
    """Table 4 with 101 bars: fresh bars as good as the true arm itself measures them, in a handful of iterations."""
    truth = table_4()
    touches = virtual.Touches(ENCODER_RAD, SEAT_MM)
    rng = np.random.default_rng(12)
    bar = virtual.bars(truth, rng, 101, 443.172, touches)
    start = virtual.wrong_start(truth, rng, 0.1, 100.0)
    found = _core.fit(core_problem(start, [bar], STATED), nothing_held(truth))
    assert found.converged
    assert found.iterations <= 12
    fresh = virtual.bars(truth, rng, 120, 443.172, touches)
    rows = Lengths(fresh.q_rad[0::2], fresh.q_rad[1::2], np.full(120, 443.172))
    ours = rows.residuals(truth.with_parameters(found.parameters), np.zeros(0))
    best = rows.residuals(truth, np.zeros(0))
    assert np.sqrt((ours**2).mean()) < 1.25 * np.sqrt((best**2).mean())
    # The stated covariance matches the errors actually made: the sum of squares is a chi squared of 25.
    off = (found.parameters - truth.parameters)[DETERMINED]
    covariance = found.covariance[np.ix_(DETERMINED, DETERMINED)]
    scale = np.sqrt(np.diag(covariance))
    squares = off / scale @ np.linalg.solve(covariance / np.outer(scale, scale), off / scale)
    assert 8.6 < squares < 52.6  # 99.8 % of a chi squared of 25
