"""Features known each with an uncertainty, staying or moving within it; and features in a line."""

from __future__ import annotations

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.core import core_arm
from tests.oracle.published import table_2

import ulna._core as _core

NOISE = fits.Noise(np.full(7, 5e-6), 0.008)
NORMAL_95 = 1.959963984540054
PLATE = np.array([[100.0 * i, 100.0 * j, 5.0 * i * j] for i in range(3) for j in range(3)])
U_PLATE = np.array([0.0, 0.02, 0.05, 0.01, 0.03, 0.02, 0.05, 0.02, 0.04])


def ball_bar(bend_mm=0.0):
    """Fourteen balls, 60 mm apart, in a line or along an arc this much out of it."""
    x = 60.0 * np.arange(14)
    return np.stack([x, bend_mm * 4 * (x / x[-1]) * (1 - x / x[-1]), np.zeros(14)], axis=1)


def touched(arm, features, rng, places, each=1):
    """Every feature in every place: (N, 7) exact poses, feature and placement of each."""
    stands = []
    for where in virtual.random_points(arm, rng, 10 * places):
        turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))
        spots = (features - features.mean(axis=0)) @ turn.T + 0.7 * where
        if np.isfinite(virtual.try_poses(arm, spots, rng)).all():
            stands.append(np.repeat(spots, each, axis=0))
        if len(stands) == places:
            break
    assert len(stands) == places
    q = virtual.poses_for_points(arm, np.concatenate(stands), rng)
    return q, np.tile(np.repeat(np.arange(len(features)), each), places), np.repeat(np.arange(places), len(stands[0]))


def problem_of(arm, features, q, feature, placement, u_mm, fitted=False, noise=NOISE):
    problem = _core.Problem(core_arm(arm), *((noise.encoder_rad, noise.seat_mm) if noise else ()))
    problem.add(
        "points",
        "artefact",
        features_mm=features,
        q_rad=q,
        probe=np.zeros(len(q), np.int64),
        feature=feature,
        placement=placement,
        feature_u_mm=u_mm,
        features_fitted=fitted,
    )
    return problem


@pytest.mark.parametrize("bend_mm", [0.0, 1e-9, 1e-6, 1e-3, 0.1])
def test_fourteen_balls_in_a_line(bend_mm):
    """A turn about the line is nobody's unknown, exactly in line or nearly: same rank, same arm, same uncertainty."""
    truth, rng = table_2(r_mm=40.0), np.random.default_rng(1)
    straight, features = ball_bar(), ball_bar(bend_mm)
    q, feature, placement = touched(truth, straight, rng, 6)
    start = virtual.wrong_start(truth, rng, 0.005, 1.0)
    start = start.with_parameters(np.where(np.isin(np.arange(27), [0, 3]), truth.parameters, start.parameters))
    found = _core.fit(problem_of(start, features, q, feature, placement, np.zeros(14)), np.zeros(27, bool))
    exact = _core.fit(problem_of(start, straight, q, feature, placement, np.zeros(14)), np.zeros(27, bool))
    assert found.converged
    assert found.identifiability.determined == exact.identifiability.determined == 25
    assert found.rms_mm < 1e-8 + bend_mm
    u = np.sqrt(np.diag(exact.covariance))
    assert abs(found.parameters - truth.parameters).max() < 1e-7 + bend_mm
    # what the bend leaves is more than the stated noise, and scales what is uncertain
    ratio = np.sqrt(np.diag(found.covariance) / found.variance)[1:] / np.where(u > 0, u, 1.0)[1:]
    assert np.nanmax(abs(ratio[u[1:] > 0] - 1.0)) < 0.1


def test_balls_in_a_line_move_along_it_only():
    truth, rng = table_2(r_mm=40.0), np.random.default_rng(2)
    features = ball_bar() @ np.linalg.qr(rng.standard_normal((3, 3)))[0].T  # a line that is no axis
    q, feature, placement = touched(truth, features, rng, 4)
    problem = problem_of(truth, features, q, feature, placement, np.full(14, 0.01), True)
    names = [name for name in problem.parameter_names if name.startswith("artefact.")]
    assert len(names) == 14
    assert all(name.endswith(".along") for name in names)
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool))
    assert found.converged
    # neither the base frame nor a shift of all balls along the line is seen; the shift has its priors
    assert found.identifiability.determined == found.identifiability.parameters - 2


def test_features_that_move_find_their_places():
    """An arm that is known, a plate that is not: the touches tell its balls, but for a rigid motion, which stays."""
    truth, rng = table_2(r_mm=40.0), np.random.default_rng(3)
    true_plate = PLATE + 0.05 * rng.standard_normal(PLATE.shape)
    q, feature, placement = touched(truth, true_plate, rng, 4)
    problem = problem_of(
        truth, PLATE, q, feature, placement, np.full(9, 0.05), True, fits.Noise(np.full(7, 1e-9), 1e-5)
    )
    hold = np.arange(len(problem.parameter_names)) < 27
    found = _core.fit(problem, hold)
    assert found.converged
    moved = found.parameters[27:].reshape(9, 3)
    distances = [np.linalg.norm(p[:, None] - p[None], axis=2) for p in (moved, true_plate, PLATE)]
    assert abs(distances[0] - distances[1]).max() < 1e-4
    assert abs(distances[2] - distances[1]).max() > 0.05


@pytest.mark.slow
@pytest.mark.parametrize("fitted", [False, True])
@pytest.mark.parametrize("kind", ["plate", "plate, one touch each", "ball bar"])
def test_intervals_hold_the_truth(kind, fitted):
    """Each run draws the artefact anew: each feature by its own uncertainty; 1000 runs."""
    truth, rng = table_2(r_mm=40.0), np.random.default_rng(4)
    features, u_mm, places = (ball_bar(), np.full(14, 0.02), 8) if kind == "ball bar" else (PLATE, U_PLATE, 12)
    q, feature, placement = touched(truth, features, rng, places)
    if "one touch" in kind:  # a plate of its own in each place: every feature is touched once
        features, u_mm = np.tile(features, (places, 1)), np.tile(u_mm, places)
        feature = np.arange(len(feature))
    problem = problem_of(truth, features, q, feature, placement, u_mm, fitted)
    parameters = len(problem.parameter_names)
    values, u, converged = _core.recalibrate(problem, np.zeros(parameters, bool), core_arm(truth), 1000, 1, 2)
    assert converged.all()
    held = (abs(values - problem.parameters) < NORMAL_95 * u)[:, :27]
    determined = np.isfinite(u[:, :27]).all(axis=0)
    assert determined.sum() == 25
    share = held[:, determined].mean(axis=0)
    assert share.min() > 0.925, share
    assert share.max() < 0.975, share


def test_a_feature_that_is_touched_once_is_that_much_noisier():
    """Its uncertainty is added to the reading's: the same fit as with a seat that is that much worse."""
    truth, rng = table_2(r_mm=40.0), np.random.default_rng(5)
    points = virtual.coordinates(truth, rng, 90, False, virtual.Touches(5e-6, 0.02))
    rows = {"q_rad": points.q_rad, "probe": np.zeros(90, np.int64), "feature": np.arange(90)}
    found = []
    for u_mm, seat_mm in ((0.03, 0.02), (0.0, np.hypot(0.03, 0.02))):
        problem = _core.Problem(core_arm(truth), NOISE.encoder_rad, float(seat_mm))
        grid = {"features_mm": points.features_mm, "frame": "arm", "feature_u_mm": np.full(90, u_mm)}
        problem.add("points", "tracker", **grid, **rows)
        found.append(_core.fit(problem, np.zeros(27, bool)))
    ours, noisier = found
    np.testing.assert_allclose(ours.parameters, noisier.parameters, rtol=0, atol=1e-9)
    np.testing.assert_allclose(ours.covariance, noisier.covariance, rtol=1e-5, atol=1e-18)
