"""Rigid transforms and links between axes, where rounding and special positions could spoil them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ulna import Joint
from ulna.arm.frames.links import link_at_zero, link_between
from ulna.arm.frames.rigid import apart, from_rpy, smallest_turn, to_rpy

quarter = st.integers(-2, 2).map(lambda k: k * math.pi / 2)
noise = st.sampled_from([0.0, 1e-16, -1e-15, 1e-13, -1e-10, 1e-7, 1e-4])
angle = st.builds(lambda a, b: a + b, quarter, noise) | st.floats(-math.pi, math.pi)


@given(angle, angle, angle)
def test_fixed_angles_there_and_back(roll: float, pitch: float, yaw: float) -> None:
    r = from_rpy(roll, pitch, yaw)
    assert np.abs(r - Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()).max() < 3e-15
    assert np.abs(from_rpy(*to_rpy(r)) - r).max() < 3e-15
    given_back = to_rpy(r, near=np.array([roll, pitch, yaw]))
    assert np.abs(from_rpy(*given_back) - r).max() < 3e-15
    if abs(math.cos(pitch)) > 0.1 or pitch == math.pi / 2:  # in between, few digits of roll and yaw are known
        assert given_back == pytest.approx([roll, pitch, yaw], abs=1e-14)


def test_of_many_fixed_angles_the_nearest() -> None:
    assert to_rpy(from_rpy(0.3, math.pi / 2, 0.5), near=np.array([0.3, 1.5, 0.5]))[2] == 0.5
    assert to_rpy(from_rpy(0.1, 0.2, 0.3), near=np.array([-3.0, 3.0, 3.4])) == pytest.approx(
        [0.1 - math.pi, math.pi - 0.2, 0.3 + math.pi]
    )
    assert to_rpy(from_rpy(0.1, 0.2, 0.3), near=np.array([6.3, 0.0, -6.3])) == pytest.approx(
        [0.1 + 2 * math.pi, 0.2, 0.3 - 2 * math.pi]
    )


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 0.3, 1.5, 3.0, math.pi - 0.05, math.pi - 1e-3])
def test_the_smallest_turn_is_a_rotation_onto_the_axis(tilt: float) -> None:
    for azimuth in np.linspace(0, 6, 7):
        w = np.array([math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt)])
        r = smallest_turn(w)
        assert np.array_equal(r[:, 2], w)
        assert np.abs(r.T @ r - np.eye(3)).max() < 1e-15
        assert np.linalg.norm(Rotation.from_matrix(r).as_rotvec()) == pytest.approx(tilt, abs=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("noise", [0.0, 1e-15, -1e-15, 1e-13, -1e-13])
def test_rounding_does_not_choose_the_side_of_a_common_normal(way: float, noise: float) -> None:
    link = link_between(np.array([30.0, 20.0, 10.0]), np.array([way, noise, 0.0]))
    assert link.theta0_rad == pytest.approx(-math.pi / 2)
    assert (link.a_mm, link.d_mm) == pytest.approx((20.0, 10.0))


link = st.builds(
    lambda theta0, alpha, a, fourth, hayati: Joint(
        theta0, alpha, a, 0.0 if hayati else fourth, fourth / 5000 if hayati else 0.0, 1, "hayati" if hayati else "dh"
    ),
    st.floats(-3, 3),
    st.floats(0.06, 3.0) | st.floats(-3.0, -0.06),
    st.floats(1, 500) | st.floats(-500, -1),
    st.floats(-500, 500),
    st.booleans(),
)


@given(link, link)
def test_a_link_like_another_is_that_link(one: Joint, other: Joint) -> None:
    like = one if one.model == other.model else other
    t = link_at_zero(one)
    if one.model == "hayati" and abs(t[2, 2]) < 0.2:
        return
    again = link_between(t[:3, 3], t[:3, 2], like=one)
    assert again.model == one.model
    assert apart(again.theta0_rad, one.theta0_rad) < 1e-9
    assert apart(again.alpha_rad, one.alpha_rad) < 1e-9
    assert (again.a_mm, again.d_mm, again.beta_rad) == pytest.approx((one.a_mm, one.d_mm, one.beta_rad), abs=1e-9)
    free = link_between(t[:3, 3], t[:3, 2], like=like)
    t_free = link_at_zero(free)
    assert np.abs(t_free[:3, 2] - t[:3, 2]).max() < 1e-12
    assert np.abs(np.cross(t_free[:3, 3] - t[:3, 3], t[:3, 2])).max() < 1e-9
