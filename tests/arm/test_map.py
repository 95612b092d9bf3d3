"""The forward map: encoder angles to tips, against the oracle's matrices and against fifty digits."""

import mpmath as mp
import numpy as np
import pytest
from tests.oracle import arms
from tests.oracle.core import core_arm
from tests.oracle.published import table_2, table_4
from tests.oracle.virtual import random_poses

import ulna._core as _core


@pytest.fixture(params=arms.ALL, ids=str)
def arm(request):
    return arms.ALL[request.param]()


# Sizes around the widths of the vector kernels, so that a tail that is handled wrongly shows.
@pytest.mark.parametrize("count", [0, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 33, 1000])
def test_tips_are_those_of_the_oracle(arm, count):
    q = random_poses(arm, np.random.default_rng(count), count)
    core = core_arm(arm)
    for probe in range(arm.probes):
        expected = arm.tip(q, probe) if count else np.zeros((0, 3))
        assert core.tip(q, probe).shape == (count, 3)
        np.testing.assert_allclose(core.tip(q, probe), expected, rtol=0, atol=5e-12)


def test_the_plain_map_agrees_with_the_fast_one(arm):
    q = random_poses(arm, np.random.default_rng(3), 501)
    core = core_arm(arm)
    np.testing.assert_allclose(core.tip_plain(q), core.tip(q), rtol=0, atol=5e-12)
    np.testing.assert_allclose(core.tip_plain(q), arm.tip(q), rtol=0, atol=5e-12)


def test_each_row_may_have_its_own_probe():
    arm = arms.snake()
    rng = np.random.default_rng(4)
    q, probe = random_poses(arm, rng, 37), rng.integers(0, 2, 37)
    np.testing.assert_allclose(core_arm(arm).tip(q, probe), arm.tip(q, probe), rtol=0, atol=5e-12)


def exact_tip(arm, q):
    """The chain in fifty digits, for one pose."""

    def turn(axis, angle):
        c, s = mp.cos(angle), mp.sin(angle)
        m = mp.eye(4)
        j, k = (axis + 1) % 3, (axis + 2) % 3
        m[j, j] = m[k, k] = c
        m[j, k], m[k, j] = -s, s
        return m

    def shift(axis, distance):
        m = mp.eye(4)
        m[axis, 3] = mp.mpf(distance)
        return m

    frame = mp.eye(4)
    for i in range(arm.joints - 1):
        frame *= turn(2, arm.sign[i] * mp.mpf(q[i]) - mp.mpf(arm.theta0_rad[i]))
        if not arm.hayati[i]:
            frame *= shift(2, arm.last[i])
        frame *= shift(0, arm.a_mm[i]) * turn(0, mp.mpf(arm.alpha_rad[i]))
        if arm.hayati[i]:
            frame *= turn(1, mp.mpf(arm.last[i]))
    frame *= turn(2, arm.sign[-1] * mp.mpf(q[-1]))
    tip = frame * mp.matrix([*map(mp.mpf, arm.tips_mm[0]), 1])
    return np.array([float(tip[k]) for k in range(3)])


def test_tips_are_right_to_the_last_digits(arm):
    q = random_poses(arm, np.random.default_rng(8), 25)
    with mp.workdps(50):
        exact = np.array([exact_tip(arm, row) for row in q])
    assert np.abs(core_arm(arm).tip(q) - exact).max() < 3e-12


@pytest.mark.parametrize("turns", [2, 100, 10_000])
def test_encoders_that_have_turned_many_times(turns):
    """An encoder may count on: the argument reduction of sine and cosine must not lose digits of the angle."""
    arm = table_4()
    q = random_poses(arm, np.random.default_rng(9), 20) + 2 * np.pi * turns
    with mp.workdps(50):
        exact = np.array([exact_tip(arm, row) for row in q])
    # The sum reading - theta0 is rounded: half a unit in the last place of the angle times the reach, seven times.
    rounding = 7 * np.spacing(2 * np.pi * turns) * core_arm(arm).reach_mm()
    assert np.abs(core_arm(arm).tip(q) - exact).max() < 3e-12 + rounding


def test_special_angles():
    """Zeros, right angles and the seam at π, where reductions change branch."""
    special = np.array([0.0, -0.0, 1e-300, 1e-9, np.pi / 4, np.pi / 2, np.pi, -np.pi, 3 * np.pi / 2, 2 * np.pi])
    arm = table_2()
    q = np.stack(np.meshgrid(special, special, indexing="ij"), axis=-1).reshape(-1, 2)
    q = np.hstack([q, np.roll(q, 3, axis=0), np.roll(q, 7, axis=0), q[:, :1]])
    np.testing.assert_allclose(core_arm(arm).tip(q), arm.tip(q), rtol=0, atol=5e-12)


def test_names_and_units_of_the_parameters():
    core = core_arm(arms.parallel_axes(), ["ball"])
    assert core.joints == 6
    assert core.parameter_names[:8] == [
        *("joint.1.theta0", "joint.1.alpha", "joint.1.a", "joint.1.d"),
        *("joint.2.theta0", "joint.2.alpha", "joint.2.a", "joint.2.beta"),
    ]
    assert core.parameter_names[-3:] == ["probe.ball.x", "probe.ball.y", "probe.ball.z"]
    assert core.parameter_units[:8] == ["rad", "rad", "mm", "mm", "rad", "rad", "mm", "rad"]
    assert core.parameter_units[-3:] == ["mm"] * 3


@pytest.mark.parametrize(("build", "count"), [(table_2, 27), (arms.six_axes, 23), (arms.elbow, 7), (arms.snake, 38)])
def test_the_number_of_parameters(build, count):
    """27 for seven axes and 23 for six, as in the literature; three more for each further probe."""
    arm = build()
    assert len(core_arm(arm).parameter_names) == count == len(arm.parameters)


def test_parameters_go_in_and_come_out(arm):
    core = core_arm(arm)
    np.testing.assert_array_equal(core.parameters, arm.parameters)
    moved = arm.parameters + np.linspace(-0.1, 0.1, len(arm.parameters))
    again = core.with_parameters(moved)
    np.testing.assert_array_equal(again.parameters, moved)
    np.testing.assert_array_equal(core.parameters, arm.parameters)  # an arm does not change
    q = random_poses(arm, np.random.default_rng(2), 9)
    np.testing.assert_allclose(again.tip(q), arm.with_parameters(moved).tip(q), rtol=0, atol=5e-12)


def test_nothing_is_farther_than_the_reach(arm):
    q = random_poses(arm, np.random.default_rng(6), 5000)
    assert np.linalg.norm(core_arm(arm).tip(q), axis=1).max() <= core_arm(arm).reach_mm()


@pytest.mark.parametrize("shape", [(4, 6), (4, 8), (7,)])
def test_readings_of_another_arm_are_refused(shape):
    with pytest.raises((ValueError, TypeError)):
        core_arm(table_2()).tip(np.zeros(shape))


def test_a_probe_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match="probe"):
        core_arm(table_2()).tip(np.zeros((1, 7)), 1)


def test_the_core_says_what_it_runs_on():
    assert _core.simd_level() in {"avx512", "avx2", "neon", "scalar"}
