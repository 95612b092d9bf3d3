"""Beyond geometry, the map and its derivatives: the formulas as written, by matrices and complex steps."""

import numpy as np
import pytest
from tests.oracle import arms
from tests.oracle.chain import COMPLEX_STEP
from tests.oracle.core import core_arm, split
from tests.oracle.effects import affected
from tests.oracle.published import table_2
from tests.oracle.virtual import random_poses

BLOCKS = [
    "harmonics",
    "backlash",
    "expansion",
    "compliance",
    "harmonics compliance",
    "backlash expansion",
    "harmonics backlash expansion compliance",
]


def readings(arm, rng, count=37):
    """Poses, each link with a temperature of its own and each joint approached from anywhere; 37: no multiple of any
    vector's width."""
    warmth_k, approach = rng.uniform(-8, 12, (count, arm.joints)), rng.integers(-1, 2, (count, arm.joints))
    return np.hstack([random_poses(arm, rng, count), warmth_k, approach])


@pytest.mark.parametrize("blocks", BLOCKS)
@pytest.mark.parametrize("name", arms.ALL)
def test_tips_and_derivatives_are_those_of_the_oracle(name, blocks):
    rng = np.random.default_rng(3)
    arm = affected(arms.ALL[name](), rng, blocks, orders=(1, 2, 5))
    seen = readings(arm, rng)
    q, *told = split(arm, seen)
    core = core_arm(arm)
    for probe in range(arm.probes):
        np.testing.assert_allclose(core.tip(q, probe, *told), arm.tip(seen, probe), rtol=0, atol=1e-9)
        np.testing.assert_allclose(core.tip_plain(q, probe, *told), arm.tip(seen, probe), rtol=0, atol=1e-9)
        # compliance: the moment is in N m and the tip in mm, so a column may be of the size 1e5
        expected = arm.jacobian(seen, probe)
        scale = np.maximum(1.0, abs(expected).max(axis=(0, 1)))
        found = core.jacobian(q, probe, *told)
        np.testing.assert_allclose(found / scale, expected / scale, rtol=0, atol=1e-11)
        encoders = arm.encoder_jacobian(seen, probe)
        np.testing.assert_allclose(core.encoder_jacobian(q, probe, *told), encoders, rtol=0, atol=1e-9)


def test_gravitys_moment_is_the_slope_of_the_energy():
    """What the oracle says of moments, by virtual work: dU = −moment · dturn."""
    arm = affected(arms.snake(), np.random.default_rng(1), "compliance")
    turns = arm.rigid_turns(random_poses(arm, np.random.default_rng(2), 20)).astype(complex)
    for i in range(arm.joints):
        moved = turns.copy()
        moved[:, i] += 1j * COMPLEX_STEP
        slope = arm.energy_nm(moved).imag / COMPLEX_STEP
        np.testing.assert_allclose(arm.moments_nm(turns.real)[:, i], -slope, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", ["seven axes", "parallel axes"])
def test_effects_of_zero_are_no_effects(name):
    plain = arms.ALL[name]()
    rng = np.random.default_rng(4)
    arm = affected(plain, rng)
    parameters = arm.parameters
    parameters[len(plain.parameters) :] = 0.0
    core, q = core_arm(arm.with_parameters(parameters)), random_poses(plain, rng, 11)
    np.testing.assert_array_equal(core.tip(q, 0, np.full(11, 5.0), np.ones(q.shape)), core_arm(plain).tip(q))


def test_one_temperature_for_all_links_is_each_links_own():
    rng = np.random.default_rng(5)
    arm = affected(table_2(), rng, "expansion")
    q, core, warmth = random_poses(arm, rng, 9), core_arm(arm), rng.uniform(-5, 5, 9)
    np.testing.assert_array_equal(core.tip(q, 0, warmth), core.tip(q, 0, np.repeat(warmth[:, None], 7, axis=1)))


def test_the_public_checker_finds_them_right():
    rng = np.random.default_rng(6)
    arm = affected(arms.snake(), rng, "harmonics backlash compliance")
    q, _, approach = split(arm, readings(arm, rng, 10))
    assert core_arm(arm).check_jacobian(q, approach=approach) < 1e-7


def test_a_doubled_mass_is_a_halved_compliance():
    """Only their product moves anything, which is why rough masses do."""
    rng = np.random.default_rng(7)
    arm = affected(table_2(), rng, "compliance")
    heavy = core_arm(
        arm.__class__(
            **{**vars(arm), "masses_kg": 2 * arm.masses_kg, "compliance_rad_per_nm": arm.compliance_rad_per_nm / 2}
        )
    )
    q = random_poses(arm, rng, 10)
    np.testing.assert_allclose(heavy.tip(q), core_arm(arm).tip(q), rtol=0, atol=1e-10)
