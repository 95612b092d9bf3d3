"""The virtual arm of the core: poses that put the tip on points."""

import numpy as np
import pytest
from tests.oracle.core import core_arm
from tests.oracle.published import six_axes, table_4
from tests.oracle.virtual import random_points

WIDE = np.tile([-np.pi, np.pi], (7, 1))


@pytest.mark.parametrize("build", [table_4, six_axes])
def test_the_tip_stands_on_the_point(build):
    arm = build()
    points = random_points(arm, np.random.default_rng(1), 200)
    limits = WIDE[: arm.joints]
    q, reached = core_arm(arm).pose_for_points(points, limits, seed=3)
    assert reached.all()
    assert np.linalg.norm(arm.tip(q) - points, axis=1).max() < 1e-8
    assert (q >= limits[:, 0]).all()
    assert (q <= limits[:, 1]).all()


def test_limits_are_kept():
    arm = table_4()
    limits = np.array([[-3.0, 3.0], [-1.0, 2.6], [-3.0, 3.0], [-1.0, 2.6], [-3.0, 3.0], [-1.0, 2.6], [-3.0, 3.0]])
    q = np.random.default_rng(2).uniform(limits[:, 0], limits[:, 1], (100, 7))
    points = arm.tip(q)
    found, reached = core_arm(arm).pose_for_points(points, limits, seed=4)
    assert reached.mean() > 0.95
    assert (found[reached] >= limits[:, 0]).all()
    assert (found[reached] <= limits[:, 1]).all()
    assert np.linalg.norm(arm.tip(found[reached]) - points[reached], axis=1).max() < 1e-8


def test_the_same_seed_gives_the_same_poses_and_another_seed_others():
    arm = table_4()
    points = random_points(arm, np.random.default_rng(5), 20)
    first, _ = core_arm(arm).pose_for_points(points, WIDE, seed=1)
    again, _ = core_arm(arm).pose_for_points(points, WIDE, seed=1)
    other, _ = core_arm(arm).pose_for_points(points, WIDE, seed=2)
    np.testing.assert_array_equal(first, again)
    assert (abs(first - other).max(axis=1) > 0.1).all()


def test_elbow_and_wrist_differ_from_touch_to_touch():
    """Poses in one seat must spread, or a calibration learns nothing from them."""
    arm = table_4()
    point = random_points(arm, np.random.default_rng(6), 1)
    q, reached = core_arm(arm).pose_for_points(np.repeat(point, 64, axis=0), WIDE, seed=7)
    assert reached.all()
    assert (q.std(axis=0) > 0.5).all()


def test_what_cannot_be_reached_is_said():
    arm = table_4()
    points = np.array([[5000.0, 0.0, 0.0], [600.0, 200.0, 500.0]])
    _, reached = core_arm(arm).pose_for_points(points, WIDE, seed=1)
    assert reached.tolist() == [False, True]
