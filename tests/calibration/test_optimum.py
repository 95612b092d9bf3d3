"""Noisy readings of every artefact: the optimum and the covariance are those of SciPy on the oracle's residuals."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.core import core_problem, nothing_held
from tests.oracle.observed import Lengths
from tests.oracle.published import table_4

import ulna._core as _core

STATED = fits.Noise(np.array([5e-6, 6e-6, 4e-6, 8e-6, 5e-6, 1e-5, 1.2e-5]), 0.008)
TOUCHES = virtual.Touches(6e-6, 0.008)
FRAME = [0, 3]  # joint.1.theta0, joint.1.d
SCALE = [11]  # joint.3.d stands for it


def noisy_lengths(arm, rng):
    bar = virtual.bars(arm, rng, 60, 443.172, TOUCHES)
    return Lengths(bar.q_rad[0::2], bar.q_rad[1::2], np.full(60, 443.172))


KINDS = {
    "length": (lambda arm, rng: [noisy_lengths(arm, rng)], FRAME),
    "bar, once": (lambda arm, rng: [virtual.bars(arm, rng, 45, 443.172, TOUCHES)], FRAME),
    "bar, often": (lambda arm, rng: [virtual.bars(arm, rng, 12, 443.172, TOUCHES, each=4)], FRAME),
    "seats": (lambda arm, rng: [virtual.seats(arm, rng, 2, 40, TOUCHES)], FRAME + SCALE),
    "points, free": (lambda arm, rng: [virtual.plate(arm, rng, 7, TOUCHES)], FRAME),
    "points, one frame": (lambda arm, rng: [virtual.coordinates(arm, rng, 60, True, TOUCHES)], FRAME),
    "points, arm": (lambda arm, rng: [virtual.coordinates(arm, rng, 60, False, TOUCHES)], []),
    "mixture": (
        lambda arm, rng: [
            virtual.bars(arm, rng, 10, 443.172, TOUCHES),
            virtual.seats(arm, rng, 2, 12, TOUCHES),
            noisy_lengths(arm, rng),
        ],
        FRAME,
    ),
}


@pytest.fixture(params=KINDS, ids=str)
def case(request):
    build, held = KINDS[request.param]
    rng = np.random.default_rng(list(KINDS).index(request.param))
    truth = table_4()
    start = virtual.wrong_start(truth, rng, 0.01, 3.0)
    start = start.with_parameters(np.where(np.isin(np.arange(27), held), truth.parameters, start.parameters))
    hold = nothing_held(truth)
    hold[held] = True
    return build(truth, rng), start, hold


@pytest.mark.parametrize("noise", [None, STATED], ids=["unweighted", "weighted"])
def test_optimum_and_covariance(case, noise):
    groups, start, hold = case
    found = _core.fit(core_problem(start, groups, noise), hold)
    assert found.converged
    ours = start.with_parameters(found.parameters)
    # Weights belong to the arm that was found: the oracle is given the same.
    oracle = fits.fit(groups, ours, ~hold, noise, white_at=ours)
    covariance = oracle.covariance(stated=noise is not None)
    u = np.sqrt(np.diag(covariance))

    # The core widens each covariance by a millionth, so that one without seat noise can be inverted.
    assert found.cost == pytest.approx(oracle.cost, rel=3e-6)
    off = (ours.parameters - oracle.arm.parameters)[~hold] / u
    assert abs(off).max() < 1e-3  # in standard uncertainties

    np.testing.assert_array_equal(found.covariance_columns, np.flatnonzero(~hold))
    scaled = found.covariance / np.outer(u, u)
    np.testing.assert_allclose(scaled, covariance / np.outer(u, u), rtol=0, atol=1e-4)
    observations = sum(g.residuals(start, g.unknowns(start)).size for g in groups)
    assert found.observations == observations
    if noise is not None:
        assert found.chi2_per_dof == pytest.approx(oracle.cost / found.degrees_of_freedom, rel=3e-6)
    else:
        assert found.chi2_per_dof is None


@pytest.mark.parametrize("kind", ["bar, often", "points, free", "mixture"])
def test_holding_the_frame_or_leaving_it_free_is_the_same(kind):
    """What is lost stays at its start value: the same optimum, the same uncertainties of everything else."""
    build, held = KINDS[kind]
    rng = np.random.default_rng(21)
    truth = table_4()
    groups = build(truth, rng)
    start = virtual.wrong_start(truth, rng, 0.01, 3.0)
    hold = nothing_held(truth)
    hold[held] = True
    with_hold = _core.fit(core_problem(start, groups, STATED), hold)
    free = _core.fit(core_problem(start, groups, STATED), nothing_held(truth))
    assert free.identifiability.determined == 25
    assert free.degrees_of_freedom == with_hold.degrees_of_freedom
    np.testing.assert_array_equal(free.parameters[held], start.parameters[held])
    u = np.sqrt(np.diag(with_hold.covariance))
    assert (abs(free.parameters - with_hold.parameters)[~hold] / u).max() < 1e-3
    u_free = np.sqrt(np.diag(free.covariance))
    np.testing.assert_allclose(u_free[~hold], u, rtol=1e-4)
    np.testing.assert_array_equal(u_free[hold], 0.0)


@pytest.mark.parametrize("kind", ["length", "bar, often", "points, arm"])
def test_residuals_and_weights_are_as_a_person_reads_them(kind):
    build, held = KINDS[kind]
    truth = table_4()
    groups = build(truth, np.random.default_rng(31))
    hold = nothing_held(truth)
    hold[held] = True
    found = _core.fit(core_problem(truth, groups, STATED), hold)
    arm = truth.with_parameters(found.parameters)
    oracle = fits.fit(groups, arm, np.zeros(27, bool), STATED)
    white = fits.whitener(groups, arm, STATED)[0]
    components = white.shape[1]
    undone = np.linalg.solve(white, oracle.residuals.reshape(-1, components)[..., None])[..., 0]
    np.testing.assert_allclose(found.residuals(0), undone, rtol=0, atol=1e-6)
    assert found.rms_mm == pytest.approx(np.sqrt((undone**2).sum(axis=1).mean()), rel=1e-6)
    weights = found.weights(0)
    assert weights.shape == (len(undone),)
    # Isotropic equivalent: between the strongest and the weakest direction of the reading's covariance.
    singular = np.linalg.svd(white, compute_uv=False)
    assert (weights <= singular.max(axis=1) * (1 + 1e-6)).all()
    assert (weights >= singular.min(axis=1) * (1 - 1e-6)).all()


def test_an_uncertain_bar_makes_uncertain_lengths():
    """Common to all its readings, the uncertainty of the bar does not average out: it goes straight into the scale."""
    truth = table_4()
    rng = np.random.default_rng(41)
    group = noisy_lengths(truth, rng)
    from tests.oracle.core import core_arm

    def fitted(u_mm):
        problem = _core.Problem(core_arm(truth), STATED.encoder_rad, STATED.seat_mm)
        rows = {"q_rad": group.q_rad, "p_rad": group.p_rad, "probe": np.zeros(len(group.q_rad), np.int64)}
        length = [("length", group.length_mm[0], u_mm, False)]
        problem.add("length", "bar", measured_mm=group.length_mm, dimensions=length, **rows)
        return _core.fit(problem, nothing_held(truth))

    exact, uncertain = fitted(0.0), fitted(0.05)
    arm = truth.with_parameters(exact.parameters)
    free = np.ones(27, bool)
    free[FRAME] = False
    white = fits.whitener([group], arm, STATED)[0][:, 0, 0]
    j = white[:, None] * group.jacobian(arm, np.zeros(0))[0][:, free]
    by_length = np.linalg.lstsq(j, white, rcond=None)[0]  # how the parameters follow the stated length
    expected = exact.covariance[np.ix_(free, free)] + 0.05**2 * np.outer(by_length, by_length)
    u = np.sqrt(np.diag(expected))
    got = uncertain.covariance[np.ix_(free, free)]
    np.testing.assert_allclose(got / np.outer(u, u), expected / np.outer(u, u), rtol=0, atol=2e-3)


def test_poorly_conditioned_but_determined():
    """A probe 0.1 mm off its axis, scaled condition 1e-4: digits are lost, but not the answer."""
    from tests.oracle.published import table_2

    truth = table_2(r_mm=0.1)
    rng = np.random.default_rng(51)
    groups = [virtual.random_lengths(truth, rng, 200)]
    start = truth.with_parameters(truth.parameters + np.where(truth.angular, 1e-4, 0.02) * rng.standard_normal(27))
    start = replace(start, tips_mm=truth.tips_mm)
    found = _core.fit(core_problem(start, groups), nothing_held(truth))
    off = abs(found.parameters - truth.parameters)
    off[FRAME] = 0.0
    assert off[truth.angular].max() < 1e-7
    assert off[~truth.angular].max() < 1e-5
