"""Hayati joints as DH joints: the same tips in every pose, by a chain of matrices written here, and back again."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ulna.arm.arm import Arm
from ulna.arm.frames.links import hayati_where_parallel
from ulna.arm.frames.pure import FARTHEST_MM, pure_dh
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.exchange.export.dh import dh_table, without_beta
from ulna.exchange.importers.dh import import_dh


def chain(joints: tuple[Joint, ...], probe: Probe, q_rad: np.ndarray) -> np.ndarray:
    """(3,) `Π Rz(turn) Tz(d) Tx(a) Rx(alpha)` of a table without beta, applied to the tip."""
    t = np.eye(4)
    for joint, q in zip(joints, q_rad, strict=True):
        assert joint.beta_rad == 0.0
        c, s = math.cos(joint.sign * q - joint.theta0_rad), math.sin(joint.sign * q - joint.theta0_rad)
        ca, sa = math.cos(joint.alpha_rad), math.sin(joint.alpha_rad)
        t = t @ [
            [c, -s * ca, s * sa, joint.a_mm * c],
            [s, c * ca, -c * sa, joint.a_mm * s],
            [0, sa, ca, joint.d_mm],
            [0, 0, 0, 1],
        ]
    return (t @ [probe.x_mm, probe.y_mm, probe.z_mm, 1.0])[:3]


def random_arm(seed: int, tilt_rad: float, n: int = 6) -> Arm:
    """DH and Hayati joints in any order, the latter's next axes tilted by about so much."""
    rng = np.random.default_rng(seed)
    joints = []
    for k in range(n):
        theta0, alpha, a, d = rng.uniform(-3, 3), rng.uniform(0.5, 2.5), rng.uniform(50, 500), rng.uniform(-300, 300)
        sign = int(rng.choice([-1, 1]))
        if k == n - 1:
            joints.append(Joint(sign=sign))
        elif rng.random() < 0.5 or k == 1:
            tilts = tilt_rad * rng.uniform(0.3, 1.0, 2) * rng.choice([-1, 1], 2)
            joints.append(Joint(theta0, tilts[0], a, 0.0, tilts[1], sign, "hayati", name=f"j{k}"))
        else:
            joints.append(Joint(theta0, alpha, a, d, 0.0, sign))
    probes = {"bent": Probe(*rng.uniform(-100, 200, 3)), "straight": Probe(0.0, 0.0, 120.0)}
    return Arm("made", tuple(joints), probes)


@pytest.mark.parametrize("tilt_rad", [1e-3, 1e-2, 0.04])
@pytest.mark.parametrize("seed", range(12))
def test_the_tips_are_the_same_in_every_pose(seed: int, tilt_rad: float) -> None:
    arm = random_arm(seed, tilt_rad)
    joints, probes, kept = pure_dh(arm.joints, arm.probes)
    assert not kept
    assert all(joint.model == "dh" for joint in joints)
    assert [(joint.sign, joint.name) for joint in joints] == [(joint.sign, joint.name) for joint in arm.joints]
    q_rad = np.random.default_rng(100 + seed).uniform(-3, 3, (20, arm.n))
    # offsets of a / tilt, of which sixteen digits are kept, about axes that they are turned around by the tilt
    rounding_mm = 1e-12 / tilt_rad**2 + 1e-9
    for name in arm.probes:
        pure = [chain(joints, probes[name], q) for q in q_rad]
        np.testing.assert_allclose(pure, arm.tip(q_rad, name), atol=rounding_mm, rtol=0)
    # and the Hayati form of that is the arm itself
    again, tips, _ = hayati_where_parallel(joints, probes)
    back = replace(arm, joints=again, probes=tips)
    np.testing.assert_allclose(back.tip(q_rad, "bent"), arm.tip(q_rad, "bent"), atol=rounding_mm, rtol=0)


def test_axes_without_a_common_normal_keep_their_beta() -> None:
    """A tilt of 1e-5 rad puts it 20 km away."""
    arm = random_arm(3, 1e-2)
    joints = list(arm.joints)
    joints[1] = replace(joints[1], alpha_rad=0.0, beta_rad=1e-5, a_mm=200.0)
    arm = replace(arm, joints=tuple(joints))
    pure, remarks = without_beta(arm)
    assert [k for k, joint in enumerate(pure.joints, start=1) if joint.beta_rad] == [2]
    assert max(abs(joint.d_mm) for joint in pure.joints) < FARTHEST_MM
    assert any("joints 2 keep a column beta" in remark for remark in remarks)
    q_rad = np.random.default_rng(3).uniform(-3, 3, (20, arm.n))
    np.testing.assert_allclose(pure.tip(q_rad, "bent"), arm.tip(q_rad, "bent"), atol=1e-6)


@pytest.mark.parametrize("convention", ["dh", "modified-dh"])
def test_a_controllers_table_comes_back_as_it_went_in(tmp_path: Path, convention: str) -> None:
    """A pure table with nearly parallel axes, imported (as Hayati joints) and exported again."""
    table = (
        "joint,sign,theta0_rad,alpha_rad,a_mm,d_mm\n1,1,0.1,1.5707,0.3,88.5\n2,1,1.4,-0.0008,-56.7,574000.25\n"
        "3,1,-2.0,0.0033,-326.5,-507000.5\n4,1,0.6,1.5704,0.01,-66800.75\n5,1,0.01,-1.571,0.02,95.0\n6,1,0,0,0,0\n"
        "tip,1,0,0,0,82.5\n"
    )
    (tmp_path / "maker.csv").write_text(table)
    arm = import_dh(tmp_path / "maker.csv", tmp_path / "arm.toml", "dh").arm
    assert {joint.model for joint in arm.joints} == {"dh", "hayati"}
    pure, (remark,) = without_beta(arm)
    assert "joints 2, 3 are nearly parallel" in remark
    assert "574 m" in remark
    written = dh_table(pure, convention, tmp_path / "arm.toml")  # type: ignore[arg-type]
    if convention == "dh":
        given, found = ([line.split(",") for line in text.splitlines()[1:]] for text in (table, written))
        for one, other in zip(given, found, strict=True):
            assert [float(cell) for cell in other[3:]] == pytest.approx(
                [float(cell) for cell in one[2:]], rel=1e-9, abs=1e-9
            )
    (tmp_path / "back.csv").write_text(written)
    again = import_dh(tmp_path / "back.csv", tmp_path / "again.toml", convention).arm  # type: ignore[arg-type]
    q_rad = np.random.default_rng(5).uniform(-3, 3, (20, 6))
    np.testing.assert_allclose(again.tip(q_rad), arm.tip(q_rad), atol=1e-5)
