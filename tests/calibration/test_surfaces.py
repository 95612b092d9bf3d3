"""Touches of balls and flats: ranks, exact recovery, SciPy's optimum, intervals that hold the truth."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.core import core_arm, core_problem, nothing_held
from tests.oracle.observed import Lengths
from tests.oracle.published import table_2, table_4

import ulna._core as _core

STATED = fits.Noise(np.array([5e-6, 6e-6, 4e-6, 8e-6, 5e-6, 1e-5, 1.2e-5]), 0.008)
TOUCHES = virtual.Touches(6e-6, 0.008)
NORMAL_95 = 1.959963984540054


def ball(arm, rng):
    return [virtual.spheres(arm, rng, 8, 24)]


def hollow(arm, rng):
    return [virtual.spheres(arm, rng, 8, 24, inside=True)]


#: flats take long to make, since many places are out of reach: once for each arm
FLATS = {}


def flat(arm, rng):
    key = tuple(arm.parameters)
    FLATS[key] = FLATS.get(key) or virtual.planes(arm, np.random.default_rng(10), 10, 20)
    return [FLATS[key]]


def one_flat(arm, rng):
    return [virtual.planes(arm, rng, 1, 120)]


def flat_and_bar(arm, rng):
    (flats,) = flat(arm, rng)
    five = flats.placement < 5
    flats = replace(flats, q_rad=flats.q_rad[five], placement=flats.placement[five], normal=flats.normal[:5])
    return [flats, virtual.bars(arm, rng, 10, 443.172)]


#: readings, tip off the last axis, determined of 27: what is lost is the base frame, and of flats the scale
TABLE = [
    (ball, 40.0, 25),
    (ball, 0.0, 23),
    (hollow, 40.0, 25),
    (flat, 40.0, 24),
    (flat, 0.0, 22),
    (flat_and_bar, 40.0, 25),
]


@pytest.mark.parametrize("row", range(len(TABLE)))
def test_ranks_are_those_of_the_oracle(row):
    readings, r_mm, determined = TABLE[row]
    arm = table_2(r_mm=r_mm)
    groups = readings(arm, np.random.default_rng(row))
    assert fits.rank_of(fits.reduced_jacobian(groups, arm), 1e-8) == determined
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    assert (found.determined, found.parameters) == (determined, 27)
    causes = {direction["cause"] for direction in found.lost}
    assert causes == {"base-frame"} | ({"scale"} if readings is flat else set()) | (
        {"probe-on-axis"} if r_mm == 0.0 else set()
    )


@pytest.mark.parametrize("readings", [ball, hollow, flat_and_bar])
def test_exact_touches_give_the_truth(readings):
    truth, rng = table_4(), np.random.default_rng(2)
    groups = readings(truth, rng)
    start = virtual.wrong_start(truth, rng, 0.01, 2.0)
    start = start.with_parameters(np.where(np.isin(np.arange(27), [0, 3]), truth.parameters, start.parameters))
    found = _core.fit(core_problem(start, groups), nothing_held(truth))
    assert found.converged
    assert found.rms_mm < 1e-9
    assert abs(found.parameters - truth.parameters).max() < 1e-6


@pytest.mark.parametrize("noise", [None, STATED], ids=["unweighted", "weighted"])
@pytest.mark.parametrize("readings", [ball, hollow, flat, one_flat, flat_and_bar])
def test_optimum_and_covariance_are_scipys(readings, noise):
    rng = np.random.default_rng(3)
    truth = table_4()
    groups = [
        replace(group, q_rad=TOUCHES.read(group.q_rad, rng)) if not isinstance(group, Lengths) else group
        for group in readings(truth, rng)
    ]
    held = [0, 3] + ([11] if readings in (flat, one_flat) else [])  # joint.3.d stands for the scale
    hold = nothing_held(truth)
    hold[held] = True
    if readings is one_flat:  # it sees too little for all of the arm
        hold[:] = True
        hold[[4, 8, 12, 13, 16, 24, 25]] = False
    found = _core.fit(core_problem(truth, groups, noise), hold)
    assert found.converged
    ours = truth.with_parameters(found.parameters)
    oracle = fits.fit(groups, ours, ~hold, noise, white_at=ours)
    covariance = oracle.covariance(stated=noise is not None)
    u = np.sqrt(np.diag(covariance))
    assert found.cost == pytest.approx(oracle.cost, rel=3e-6)
    assert (abs(ours.parameters - oracle.arm.parameters)[~hold] / u).max() < 1e-3
    np.testing.assert_allclose(found.covariance / np.outer(u, u), covariance / np.outer(u, u), rtol=0, atol=1e-4)
    assert found.observations == sum(len(g.residuals(truth, g.unknowns(truth))) for g in groups)


@pytest.mark.parametrize("readings", [ball, hollow, flat])
def test_residuals_are_distances_from_the_surface(readings):
    """Positive outside of a ball and of a hollow's wall, and on the side of a flat that the arm's base is on."""
    truth, rng = table_4(), np.random.default_rng(4)
    (group,) = readings(truth, rng)
    if readings is flat:
        middle = np.stack([truth.tip(group.q_rad[group.placement == k]).mean(axis=0) for k in range(10)])
        away = (middle * group.normal).sum(axis=1, keepdims=True) > 0
        group = replace(group, normal=np.where(away, -group.normal, group.normal), balls_mm=np.zeros(1))
    group = replace(group, q_rad=group.q_rad + 2e-5 * rng.standard_normal(group.q_rad.shape))
    fitted = _core.fit(core_problem(truth, [group]), np.ones(27, bool))
    expected = group.residuals(truth, group.unknowns(truth))
    np.testing.assert_allclose(fitted.residuals(0)[:, 0], expected, rtol=0, atol=1e-7)


def diameter_problem(truth, group, start, stated, u_mm, fitted):
    problem = _core.Problem(core_arm(start), stated.encoder_rad, stated.seat_mm)
    rows = {"q_rad": group.q_rad, "probe": np.zeros(len(group.q_rad), np.int64), "placement": group.placement}
    diameter = [("diameter", group.diameter_mm, u_mm, fitted)]
    problem.add("sphere", "ball", dimensions=diameter, balls_mm=group.balls_mm, **rows)
    return problem


def test_a_ball_of_unknown_diameter_knows_no_scale():
    truth = table_2(r_mm=40.0)
    (group,) = ball(truth, np.random.default_rng(5))
    problem = diameter_problem(truth, group, truth, STATED, 0.0, True)
    assert problem.parameter_names[-1] == "artefact.ball.diameter"
    found = _core.identify(problem, np.zeros(28, bool))
    assert (found.determined, found.parameters) == (25, 28)
    (scale,) = [direction for direction in found.lost if direction["cause"] == "scale"]
    assert scale["combination"]["artefact.ball.diameter"] != 0.0


@pytest.mark.slow
@pytest.mark.parametrize("case", ["held", "considered", "fitted", "flat and bar"])
def test_intervals_hold_the_truth(case):
    """1000 simulated calibrations each: a ball's diameter exact, uncertain, fitted within; flats beside a bar."""
    truth, rng = table_2(r_mm=40.0), np.random.default_rng(6)
    if case == "flat and bar":
        problem = core_problem(truth, flat_and_bar(truth, rng), STATED)
    else:
        (group,) = ball(truth, rng)
        u_mm = 0.0 if case == "held" else 0.01
        problem = diameter_problem(truth, group, truth, STATED, u_mm, case == "fitted")
    parameters = len(problem.parameter_names)
    values, u, converged = _core.recalibrate(problem, np.zeros(parameters, bool), core_arm(truth), 1000, 1, 2)
    assert converged.all()
    determined = np.isfinite(u).all(axis=0)
    assert determined.sum() == parameters - 2
    truths = np.append(truth.parameters, 50.0)[:parameters]
    held = (abs(values - truths) < NORMAL_95 * u)[:, determined].mean(axis=0)
    assert held.min() > 0.925, held
    assert held.max() < 0.975, held


def test_a_flat_needs_no_ball_but_several_balls_need_theirs():
    """One probe's ball moves the flat, nothing else; two balls of other sizes must be known."""
    truth, rng = table_4(), np.random.default_rng(7)
    (group,) = flat(truth, rng)
    placement, probe = group.placement, np.zeros(len(group.q_rad), np.int64)
    for ball_mm in (0.0, 6.0):
        problem = _core.Problem(core_arm(truth))
        balls_mm = np.array([ball_mm])
        problem.add("plane", "flat", balls_mm=balls_mm, q_rad=group.q_rad, probe=probe, placement=placement)
        assert _core.fit(problem, np.ones(27, bool)).rms_mm < 1e-9
    two = replace(truth, tips_mm=np.vstack([truth.tips_mm, truth.tips_mm + np.array([5.0, 0.0, 30.0])]))
    larger = virtual.poses_for_points(
        two, two.tip(group.q_rad, 0) + 2.0 * group.normal[placement], rng, probe=1
    )  # a ball of 10 mm stands off 2 mm farther
    q = np.vstack([group.q_rad, larger])
    rows = {"q_rad": q, "probe": np.repeat([0, 1], len(probe)), "placement": np.tile(placement, 2)}
    problem = _core.Problem(core_arm(two))
    problem.add("plane", "flat", balls_mm=np.array([6.0, 10.0]), **rows)
    assert _core.fit(problem, np.ones(30, bool)).rms_mm < 1e-8
    wrong = _core.Problem(core_arm(two))
    wrong.add("plane", "flat", balls_mm=np.array([6.0, 6.0]), **rows)
    assert _core.fit(wrong, np.ones(30, bool)).rms_mm > 0.5
