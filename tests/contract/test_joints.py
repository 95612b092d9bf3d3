"""What every kind of joint owes, wherever it stands in the chain: map, derivatives, rank, recovery, intervals."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.simulations import off_over_u, saved, write

import ulna
from ulna import Arm, Joint, Probe

#: axes nowhere parallel, so that each number of a joint that turns is seen
ROWS = [(0.2, -1.5, 40.0, 255.0), (2.1, 1.4, -400.0, 30.0), (0.3, -1.6, 35.0, 120.0), (2.0, 1.3, -30.0, 25.0)]
PROBE = Probe(40.0, -10.0, 180.0, 6.0)
BAR = '[artefact.bar]\nkind = "bar"\nlength = 300.0\nu = 0.001\nplacements = 150\n'


def arm(number: int = 0, kind: str = "rotary", sign: int = 1) -> Arm:
    """Five joints, one of them (from 1) of another kind."""
    joints = [Joint(*row, sign=sign, limits_rad=(-2.8, 2.8)) for row in ROWS] + [Joint(limits_rad=(-3.0, 3.0))]
    if kind == "prismatic":
        joints[number - 1] = replace(joints[number - 1], type="prismatic", limits_rad=(0.0, 350.0))
    if kind == "hayati":
        joints[number - 1] = replace(joints[number - 1], model="hayati", alpha_rad=0.01, beta_rad=0.02, d_mm=0.0)
    return Arm("five joints", tuple(joints), {"bent": PROBE})


#: name: the arm, and how many of its 19 parameters coordinates in the base frame determine
KINDS: dict[str, tuple[Arm, int]] = {
    "rotary": (arm(), 19),
    **{f"hayati {k}": (arm(k, "hayati"), 19) for k in (2, 3)},
    # of its axis only the direction matters
    **{f"prismatic {k}": (arm(k, "prismatic"), 17) for k in (2, 3, 4, 5)},
    "prismatic 3, counting down": (arm(3, "prismatic", -1), 17),
}
each_kind = pytest.mark.parametrize("kind", KINDS)


def poses(of: Arm, count: int = 30) -> np.ndarray:
    low, high = np.array([joint.limits_rad for joint in of.joints]).T
    return np.random.default_rng(4).uniform(low, high, (count, of.n))


def turn(axis: str, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    found = np.eye(4)
    found[:3, :3] = {
        "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }[axis]
    return found


def shift(x: float, z: float) -> np.ndarray:
    found = np.eye(4)
    found[[0, 2], 3] = x, z
    return found


def points(of: Arm) -> str:
    """Ten places that its tip can be at, as a tracker has them in the base frame."""
    low, high = np.array([joint.limits_rad for joint in of.joints]).T
    q_rad = np.random.default_rng(9).uniform(0.8 * low + 0.2 * high, 0.2 * low + 0.8 * high, (10, of.n))
    features = ", ".join(
        f"{name} = {xyz}" for name, xyz in zip("abcdefghij", of.tip(q_rad).round(1).tolist(), strict=True)
    )
    return f'[artefact.tracker]\nkind = "points"\nframe = "arm"\nu = 0.001\ntouches = 30\nfeatures = {{ {features} }}\n'


@each_kind
def test_the_map_is_the_formula(kind: str) -> None:
    of, _ = KINDS[kind]
    for q in poses(of):
        t = np.eye(4)
        for joint, read in zip(of.joints, q.tolist(), strict=True):
            moved = (joint.sign or 1) * read
            turned, slid = (0.0, moved) if joint.type == "prismatic" else (moved, 0.0)
            t = t @ turn("z", turned - joint.theta0_rad) @ shift(joint.a_mm, joint.d_mm + slid)
            t = t @ turn("x", joint.alpha_rad) @ turn("y", joint.beta_rad)
        np.testing.assert_allclose(of.tip(q), (t @ [*PROBE.tip_mm, 1.0])[:3], rtol=0, atol=1e-10)


@each_kind
def test_derivatives_are_those_of_finite_differences(kind: str) -> None:
    of, _ = KINDS[kind]
    q_rad, found = poses(of), KINDS[kind][0].jacobian(poses(of))
    for k, value in enumerate(of.parameters.tolist()):
        ends = []
        for sign in (1.0, -1.0):
            moved = of.parameters.copy()
            moved[k] = value + sign * 1e-5
            ends.append(of.with_parameters(moved).tip(q_rad))
        np.testing.assert_allclose(found[:, :, k], (ends[0] - ends[1]) / 2e-5, rtol=0, atol=2e-5)
    by_encoder = of.core.encoder_jacobian(q_rad, 0)
    for k in range(of.n):
        step = np.eye(of.n)[k] * 1e-5
        slope = (of.tip(q_rad + step) - of.tip(q_rad - step)) / 2e-5
        np.testing.assert_allclose(by_encoder[:, :, k], slope, rtol=0, atol=2e-5)


@each_kind
def test_arm_files_come_back_as_they_were(kind: str, tmp_path: Path) -> None:
    of, _ = KINDS[kind]
    of.save(tmp_path / "arm.toml")
    assert Arm.load(tmp_path / "arm.toml").joints == of.joints
    assert of.with_parameters(of.parameters).joints == of.joints


def noise(of: Arm) -> str:
    """Encoders of 1e-5 rad, of what slides 0.01 mm."""
    each = [0.01 if joint.type == "prismatic" else 1e-5 for joint in of.joints]
    return f"noise = {{ encoder = {each}, seat = 0.01 }}"


@each_kind
def test_readings_tell_as_much_as_there_is(kind: str, tmp_path: Path) -> None:
    of, rank = KINDS[kind]
    _, study = saved(write(tmp_path, points(of), noise(of), of))
    found = ulna.identify(study)
    assert found.determined == rank
    causes = [direction["cause"] for direction in found.lost]
    assert causes == ["sliding-axis"] * (19 - rank)


@each_kind
def test_a_calibration_finds_the_arm(kind: str, tmp_path: Path) -> None:
    """From a drawing a millimetre and a twentieth of a radian off, with what its coordinates do not say."""
    of, _ = KINDS[kind]
    simulated, study = saved(write(tmp_path, points(of) + BAR, noise(of), of))
    result = ulna.calibrate(study)
    assert result.fit.converged
    assert result.fit.chi2_per_dof == pytest.approx(1.0, abs=0.15)
    off = off_over_u(simulated, result)
    assert np.abs(off).max() < 4.5
    q_rad = poses(of, 300)
    error_mm = np.linalg.norm(result.arm.tip(q_rad) - of.tip(q_rad), axis=1)
    assert error_mm.max() < 0.05
    # where it is uncertain it says so: squares of errors over variances
    measured = ulna.measure(result, q_rad[:100], encoder_u_rad=np.array([1e-12] * of.n))
    assert measured.u_mm is not None
    assert np.isfinite(measured.u_mm).all()


@pytest.mark.parametrize("number", [3, 5])
def test_intervals_hold_the_truth(number: int, tmp_path: Path) -> None:
    """Of 30 simulated studies, what says the same twice held: errors in their standard uncertainties."""
    of = arm(number, "prismatic")
    held = ["joint.3.a", "joint.3.d"] if number == 3 else ["joint.4.a", "joint.4.d"]
    off = []
    for seed in range(30):
        folder = tmp_path / str(seed)
        simulated, study = saved(write(folder, points(of) + BAR, f"seed = {seed}\ndrawing = 'exact'\n{noise(of)}", of))
        off += off_over_u(simulated, ulna.calibrate(study, hold=held)).tolist()
    assert np.mean(np.abs(off) < 1.96) == pytest.approx(0.95, abs=0.03)
