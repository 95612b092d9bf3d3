"""What is known beforehand: like readings that nobody took, by Bayes' rule where all is linear."""

from __future__ import annotations

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.core import core_arm, core_problem, nothing_held
from tests.oracle.observed import Lengths
from tests.oracle.published import table_2, table_4

import ulna._core as _core

STATED = fits.Noise(np.full(7, 5e-6), 0.008)
TOUCHES = virtual.Touches(5e-6, 0.008)
NORMAL_95 = 1.959963984540054


@pytest.mark.parametrize(("off_mm", "contradicted"), [([0.0008, -0.003, 0.005], False), ([0.02, -0.01, 0.005], True)])
def test_a_tip_by_bayes_rule(off_mm, contradicted):
    """Joints held, one seat at known coordinates: linear. The posterior is A⁻¹ b with A = JᵀWJ/s² + 1/u².

    s² is 1 where the readings bear out their stated noise. A prior 20 of its u off leaves residuals that do not,
    and then s² is theirs: the sum of squares, of the readings alone, over n - tr H.
    """
    truth, rng = table_4(), np.random.default_rng(1)
    group = virtual.coordinates(truth, rng, 40, False, TOUCHES)
    hold = np.ones(27, bool)
    hold[24:] = False
    problem = core_problem(truth, [group], STATED)
    values, u = truth.parameters[24:] + np.array(off_mm), np.array([0.001, 0.004, 10.0])
    for k in range(3):
        problem.add_prior(24 + k, values[k], u[k])
    found = _core.fit(problem, hold)

    arm = truth.with_parameters(found.parameters)
    white = np.linalg.inv(np.linalg.cholesky(group.covariance(arm, STATED.encoder_rad, STATED.seat_mm)))
    j = (white @ group.jacobian(arm, np.zeros(0))[0].reshape(-1, 3, 27))[:, :, 24:].reshape(-1, 3)
    r = (white @ group.residuals(arm, np.zeros(0)).reshape(-1, 3, 1)).ravel()
    s2 = found.variance
    a = j.T @ j / s2 + np.diag(1 / u**2)
    b = j.T @ (j @ found.parameters[24:] - r) / s2 + values / u**2
    assert found.degrees_of_freedom == pytest.approx(len(r) - np.trace(j @ np.linalg.solve(a, j.T)) / s2, rel=1e-4)
    assert s2 == pytest.approx(r @ r / found.degrees_of_freedom if contradicted else 1.0, rel=1e-3)
    np.testing.assert_allclose(
        found.parameters[24:], np.linalg.solve(a, b), rtol=0, atol=1e-6 if contradicted else 1e-7
    )
    np.testing.assert_allclose(found.covariance, np.linalg.inv(a), rtol=1e-4)
    np.testing.assert_array_equal(found.priors, np.stack([values, u], axis=1))


def test_a_wide_prior_changes_nothing_and_a_narrow_one_holds():
    truth, rng = table_4(), np.random.default_rng(2)
    bar = virtual.bars(truth, rng, 80, 443.172, TOUCHES)
    plain = _core.fit(core_problem(truth, [bar], STATED), nothing_held(truth))
    u = np.sqrt(np.diag(plain.covariance))
    wide, narrow = core_problem(truth, [bar], STATED), core_problem(truth, [bar], STATED)
    wide.add_prior(10, truth.parameters[10], 1e4 * u[10])
    narrow.add_prior(10, plain.parameters[10] + 3 * u[10], 1e-4 * u[10])
    same, held = (_core.fit(problem, nothing_held(truth)) for problem in (wide, narrow))
    determined = np.setdiff1d(np.arange(27), [0, 3])
    assert (abs(same.parameters - plain.parameters)[determined] / u[determined]).max() < 1e-4
    assert held.parameters[10] == pytest.approx(plain.parameters[10] + 3 * u[10], abs=1e-3 * u[10])
    assert held.cost == pytest.approx(plain.cost + 9.0, rel=1e-3)  # three standard uncertainties, squared


def test_a_prior_makes_up_for_what_readings_do_not_tell():
    """A straight probe: the family around joint 6 is lost; two priors on it and nothing is."""
    truth, rng = table_2(r_mm=0.0), np.random.default_rng(3)
    bar = virtual.bars(truth, rng, 80, 443.172, TOUCHES)
    problem = core_problem(truth, [bar], STATED)
    assert _core.fit(problem, nothing_held(truth)).identifiability.determined == 23
    names = problem.parameter_names
    for name, u in (("joint.6.theta0", 0.002), ("joint.6.alpha", 0.001)):
        problem.add_prior(names.index(name), truth.parameters[names.index(name)], u)
    found = _core.fit(problem, nothing_held(truth))
    assert found.identifiability.determined == 25
    assert found.identifiability.from_prior == ["joint.6.theta0", "joint.6.alpha"]
    u = np.sqrt(np.diag(found.covariance))
    assert u[names.index("joint.6.alpha")] == pytest.approx(0.001, rel=0.01)
    assert found.identifiability.weak == []


@pytest.mark.slow
@pytest.mark.parametrize("noise", [STATED, None], ids=["stated", "not stated"])
def test_intervals_hold_the_truth_where_the_prior_is_right(noise):
    """The truth is drawn from the prior in each run: intervals of what readings and prior say together."""
    arm, rng = table_2(r_mm=40.0), np.random.default_rng(4)
    bar = virtual.bars(arm, rng, 40, 443.172)
    q, p = bar.q_rad[0::2], bar.q_rad[1::2]
    lengths = [k for k in range(24) if k % 4 in (2, 3) and k != 3]
    u_mm, runs, hits, spread = 0.02, 400, np.zeros(27), np.zeros(27)
    for _ in range(runs):
        parameters = arm.parameters.copy()
        parameters[lengths] += u_mm * rng.standard_normal(len(lengths))
        truth = arm.with_parameters(parameters)
        length = np.linalg.norm(truth.tip(q) - truth.tip(p), axis=1) + 0.015 * rng.standard_normal(40)
        stated = None if noise is None else fits.Noise(np.full(7, 1e-12), 0.015 / np.sqrt(2))
        problem = core_problem(arm, [Lengths(q, p, length)], stated)
        for k in lengths:
            problem.add_prior(k, arm.parameters[k], u_mm)
        found = _core.fit(problem, nothing_held(arm))
        assert found.converged
        u = np.sqrt(np.diag(found.covariance))
        hits += abs(found.parameters - parameters) < NORMAL_95 * u
        spread += u
    determined = np.setdiff1d(np.arange(27), [0, 3])
    share = (hits / runs)[determined]
    assert (spread / runs)[lengths].max() < u_mm * 1.01
    assert 0.93 < share.mean() < 0.965, share
    assert share.min() > 0.90, share


def test_wrong_priors_are_refused():
    problem = core_problem(table_4(), [], None)
    for parameter, value, u, told in ((27, 0.0, 1.0, "27"), (0, np.nan, 1.0, "joint.1.theta0"), (0, 0.0, 0.0, "0")):
        with pytest.raises(_core.UlnaError, match=told):
            problem.add_prior(parameter, value, u)


def test_a_prior_of_an_artefact_stands_for_its_certificate():
    """The bar's length fitted within its uncertainty, or given a prior by hand: the same."""
    truth, rng = table_4(), np.random.default_rng(5)
    bar = virtual.bars(truth, rng, 40, 443.172, TOUCHES)
    rows = {"q_rad": bar.q_rad[0::2].copy(), "p_rad": bar.q_rad[1::2].copy(), "probe": np.zeros(40, np.int64)}
    found = []
    for u_mm in (0.005, 0.1):
        problem = _core.Problem(core_arm(truth), STATED.encoder_rad, STATED.seat_mm)
        length = [("length", 443.172, u_mm, True)]
        problem.add("length", "bar", measured_mm=np.full(40, 443.172), dimensions=length, **rows)
        assert problem.parameter_names[-1] == "artefact.bar.length"
        if u_mm == 0.1:
            problem.add_prior(27, 443.172, 0.005)
        found.append(_core.fit(problem, np.zeros(28, bool)))
    ours, by_hand = found
    np.testing.assert_allclose(ours.parameters, by_hand.parameters, rtol=0, atol=1e-9)
    u = np.sqrt(np.diag(ours.covariance))
    assert u[-1] == pytest.approx(0.005, rel=1e-3)  # nothing else knows a length
