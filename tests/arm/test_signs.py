"""What the documentation says of signs and of tables in the modified form, tried on the arm itself."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.cli_runs import BENT, platinum

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe

Q = np.random.default_rng(3).uniform(-3, 3, (50, 7))
HALF_TURN = np.diag([1.0, -1.0, -1.0])


@pytest.mark.parametrize("wrong", range(7))
def test_a_wrong_sign_is_the_same_arm_with_alphas_half_a_turn_on(wrong: int) -> None:
    truth = platinum()
    joints, probe = list(truth.joints), BENT
    joint = joints[wrong]
    joints[wrong] = replace(joint, sign=-joint.sign, theta0_rad=-joint.theta0_rad, d_mm=-joint.d_mm)
    if wrong > 0:
        joints[wrong - 1] = replace(joints[wrong - 1], alpha_rad=joints[wrong - 1].alpha_rad + pi)
    if wrong < 6:
        joints[wrong] = replace(joints[wrong], alpha_rad=joint.alpha_rad + pi)
    else:
        probe = Probe(BENT.x_mm, -BENT.y_mm, -BENT.z_mm)
    tips = Arm("other", tuple(joints), {"bent": probe}).tip(Q)
    expected = truth.tip(Q) @ (HALF_TURN if wrong == 0 else np.eye(3))
    np.testing.assert_allclose(tips, expected, rtol=0, atol=1e-9)


def test_a_table_in_the_modified_form_comes_over_as_told() -> None:
    rng = np.random.default_rng(4)
    alpha, offset = rng.uniform(-2, 2, (2, 4))
    a, d = rng.uniform(-300, 300, (2, 4))
    alpha[0] = a[0] = 0.0
    p_mm = rng.uniform(-100, 100, 3)
    q = Q[0, :4]
    # Craig: turn and shift along the previous normal, then along this axis
    expected = p_mm
    for k in reversed(range(4)):
        expected = Rotation.from_rotvec([0, 0, q[k] + offset[k]]).apply(expected + np.array([0, 0, d[k]]))
        expected = Rotation.from_rotvec([alpha[k], 0, 0]).apply(expected + np.array([a[k], 0, 0]))
    joints = [Joint(-offset[k], alpha[k + 1], a[k + 1], d[k]) for k in range(3)]
    tip = Rotation.from_rotvec([0, 0, offset[3]]).apply(p_mm) + np.array([0, 0, d[3]])
    arm = Arm("modified", (*joints, Joint()), {"p": Probe(*tip)})
    np.testing.assert_allclose(arm.tip(q), expected, rtol=0, atol=1e-9)
