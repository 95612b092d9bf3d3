"""Derivatives of the tip, against complex steps of the oracle: generic poses, near zero, and singular ones."""

import numpy as np
import pytest
from tests.oracle import arms
from tests.oracle.chain import chain
from tests.oracle.core import core_arm
from tests.oracle.published import table_2
from tests.oracle.virtual import random_poses


def stretched():
    """All twists zero and nothing off the axes: every axis is the same line, every pose is singular."""
    return chain([[0.0, 0.0, 0.0, 100.0]] * 5, [0.0, 0.0, 100.0])


def poses(arm, kind):
    rng = np.random.default_rng(12)
    generic = random_poses(arm, rng, 41)
    if kind == "generic":
        return generic
    if kind == "near zero":
        return generic * 10.0 ** rng.uniform(-16, -6, generic.shape)
    # Singular: every encoder at a multiple of a right angle from its zero, where axes line up or arms stretch out.
    offsets = np.append(arm.theta0_rad, 0.0)
    return np.array(arm.sign) * (offsets + np.pi / 2 * rng.integers(-2, 3, generic.shape))


BUILDERS = {**arms.ALL, "straight probe": lambda: table_2(r_mm=0.0), "one line": stretched}


@pytest.mark.parametrize("kind", ["generic", "near zero", "singular"])
@pytest.mark.parametrize("name", BUILDERS)
def test_derivatives_are_those_of_the_oracle(name, kind):
    arm = BUILDERS[name]()
    q = poses(arm, kind)
    core = core_arm(arm)
    for probe in range(arm.probes):
        np.testing.assert_allclose(core.jacobian(q, probe), arm.jacobian(q, probe), rtol=0, atol=1e-11)
        np.testing.assert_allclose(core.encoder_jacobian(q, probe), arm.encoder_jacobian(q, probe), rtol=0, atol=1e-11)


@pytest.mark.parametrize("name", BUILDERS)
def test_the_public_checker_finds_them_right(name):
    arm = BUILDERS[name]()
    assert core_arm(arm).check_jacobian(poses(arm, "generic")) < 1e-8


def test_the_other_probe_has_no_derivative():
    """A touch with one probe says nothing about the other."""
    arm = arms.snake()
    q = random_poses(arm, np.random.default_rng(1), 6)
    assert not core_arm(arm).jacobian(q, 0)[:, :, -3:].any()
    assert not core_arm(arm).jacobian(q, 1)[:, :, -6:-3].any()


def packed(matrices):
    """(N, 3, 3) → (N, 6): xx, xy, xz, yy, yz, zz."""
    return matrices[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]


def test_the_covariance_of_a_tip():
    arm, rng = table_2(), np.random.default_rng(5)
    q = random_poses(arm, rng, 19)
    columns = np.array([0, 1, 5, 6, 10, 13, 22, 24, 25, 26])
    root = rng.standard_normal((10, 10)) * np.where(arm.angular[columns], 1e-5, 1e-2)[:, None]
    covariance = root @ root.T
    j = arm.jacobian(q)[:, :, columns]
    expected = packed(j @ covariance @ j.transpose(0, 2, 1))
    np.testing.assert_allclose(core_arm(arm).tip_covariance(q, 0, columns, covariance), expected, rtol=1e-9, atol=1e-18)


def test_the_effect_of_directions_on_a_tip():
    """The worst of the directions counts, pose by pose; a direction along the other probe does nothing."""
    arm, rng = arms.snake(), np.random.default_rng(6)
    q = random_poses(arm, rng, 23)
    columns = np.arange(len(arm.parameters))
    directions = rng.standard_normal((3, len(columns)))
    expected = np.linalg.norm(np.einsum("nik,mk->nmi", arm.jacobian(q, 1), directions), axis=2).max(axis=1)
    np.testing.assert_allclose(core_arm(arm).direction_effect(q, 1, columns, directions), expected, rtol=1e-9)
    idle = np.zeros((1, len(columns)))
    idle[0, -6] = 1.0  # probe 0, x
    assert not core_arm(arm).direction_effect(q, 1, columns, idle).any()
