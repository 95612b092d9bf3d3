"""Laws that hold for every arm: rigid motions change no length, flips no tip, a mirror no distance."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.oracle import virtual
from tests.oracle.arms import parallel_axes
from tests.oracle.chain import chain
from tests.oracle.core import core_arm, core_problem
from tests.oracle.observed import Points
from tests.oracle.published import table_2

import ulna._core as _core

angle = st.floats(-np.pi, np.pi)
twist = st.floats(-3.0, 3.0)
length = st.floats(-500.0, 500.0)

#: Hypothesis explores; the seed is fixed so that a run is repeatable.
steady = settings(derandomize=True, max_examples=60, deadline=None)


@st.composite
def arms_and_poses(draw):
    joints = draw(st.integers(2, 9))
    hayati = tuple(draw(st.lists(st.booleans(), min_size=joints - 1, max_size=joints - 1)))
    links = [[draw(angle), draw(twist), draw(length), draw(twist) / 3 if tilted else draw(length)] for tilted in hayati]
    sign = tuple(draw(st.lists(st.sampled_from([-1, 1]), min_size=joints, max_size=joints)))
    arm = chain(np.array(links), [draw(length), draw(length), draw(length)], hayati, sign)
    q = np.array([[draw(st.floats(-7.0, 7.0)) for _ in range(joints)] for _ in range(3)])
    return arm, q


def tips(arm, q):
    return core_arm(arm).tip(q)


def distances(points):
    return np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)


@given(arms_and_poses(), angle, length)
@steady
def test_turning_and_lifting_the_base_changes_no_length(given_arm, turn, lift):
    arm, q = given_arm
    theta0, last = arm.theta0_rad.copy(), arm.last.copy()
    theta0[0] += turn
    if not arm.hayati[0]:
        last[0] += lift
    moved = replace(arm, theta0_rad=theta0, last=last)
    np.testing.assert_allclose(distances(tips(moved, q)), distances(tips(arm, q)), rtol=0, atol=1e-9)
    turned = tips(arm, q) @ Rotation.from_rotvec([0, 0, -turn]).as_matrix().T
    turned[:, 2] += moved.last[0] - arm.last[0]
    np.testing.assert_allclose(tips(moved, q), turned, rtol=0, atol=1e-9)


@given(arms_and_poses(), st.integers(0, 7))
@steady
def test_a_flip_moves_no_tip(given_arm, joint):
    """theta0 + π, alpha and a (and beta) negated, next theta0 + π; behind the last link the tip's x and y negated."""
    arm, q = given_arm
    i = joint % (arm.joints - 1)
    links = np.stack([arm.theta0_rad, arm.alpha_rad, arm.a_mm, arm.last], axis=1)
    links[i, 0] += np.pi
    links[i, 1:3] *= -1
    if arm.hayati[i]:
        links[i, 3] *= -1
    tip = arm.tips_mm.copy()
    if i + 1 < arm.joints - 1:
        links[i + 1, 0] += np.pi
    else:
        tip[:, :2] *= -1
    twin = chain(links, tip, arm.hayati, arm.sign)
    np.testing.assert_allclose(tips(twin, q), tips(arm, q), rtol=0, atol=1e-9)


@given(arms_and_poses())
@steady
def test_a_mirror_keeps_every_distance(given_arm):
    """All alpha, all d (and beta) and the tip's z negated: the tips are mirrored in the base plane."""
    arm, q = given_arm
    twin = replace(arm, alpha_rad=-arm.alpha_rad, last=-arm.last, tips_mm=arm.tips_mm * [1, 1, -1])
    np.testing.assert_allclose(tips(twin, q), tips(arm, q) * [1, 1, -1], rtol=0, atol=1e-9)
    np.testing.assert_allclose(distances(tips(twin, q)), distances(tips(arm, q)), rtol=0, atol=1e-9)


@given(arms_and_poses(), st.integers(0, 8))
@steady
def test_an_encoder_that_counts_backwards(given_arm, joint):
    """The other sign with the other reading is the same pose."""
    arm, q = given_arm
    i = joint % arm.joints
    sign = tuple(-s if k == i else s for k, s in enumerate(arm.sign))
    mirrored = q * [-1 if k == i else 1 for k in range(arm.joints)]
    np.testing.assert_allclose(tips(replace(arm, sign=sign), mirrored), tips(arm, q), rtol=0, atol=1e-9)


@given(arms_and_poses(), st.integers(0, 8), angle)
@steady
def test_a_zero_offset_is_a_shift_of_the_encoder(given_arm, joint, shift):
    arm, q = given_arm
    i = joint % (arm.joints - 1)
    theta0, read = arm.theta0_rad.copy(), q.copy()
    theta0[i] += shift
    read[:, i] += arm.sign[i] * shift
    np.testing.assert_allclose(tips(replace(arm, theta0_rad=theta0), read), tips(arm, q), rtol=0, atol=1e-9)


def evaluated(arm, points):
    """Cost of the readings with every parameter held: only placements move."""
    return _core.fit(core_problem(arm, [points]), np.ones(len(arm.parameters), bool))


@pytest.fixture(scope="module", params=["measuring arm", "parallel axes"])
def noisy_plate(request):
    arm = table_2() if request.param == "measuring arm" else parallel_axes()
    rng = np.random.default_rng(77)
    plate = virtual.plate(arm, rng, 3)
    return arm, replace(plate, q_rad=plate.q_rad + 1e-3 * rng.standard_normal(plate.q_rad.shape))


@given(st.tuples(angle, twist, twist), st.tuples(length, length, length))
@settings(derandomize=True, max_examples=25, deadline=None)
def test_the_frame_of_an_artefact_is_of_no_account(noisy_plate, turn, shift):
    """Its features may be written in any frame: a placement's pose is unknown anyway."""
    arm, plate = noisy_plate
    moved = Rotation.from_rotvec(turn).apply(plate.features_mm) + shift
    elsewhere = Points(moved, plate.q_rad, plate.feature, plate.placement)
    ours, other = evaluated(arm, plate), evaluated(arm, elsewhere)
    assert other.cost == pytest.approx(ours.cost, rel=1e-7)
    np.testing.assert_allclose(other.residuals(0), ours.residuals(0), rtol=0, atol=1e-5)


def test_a_mirrored_plate_is_another_plate(noisy_plate):
    """Placements turn, they do not mirror: a plate that is not flat tells left from right."""
    arm, plate = noisy_plate
    mirrored = replace(plate, features_mm=plate.features_mm * [1, 1, -1])
    assert evaluated(arm, mirrored).rms_mm > evaluated(arm, plate).rms_mm + 1.0
