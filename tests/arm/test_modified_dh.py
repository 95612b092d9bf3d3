"""The modified Denavit–Hartenberg form comes over exactly: from arm files, from tables, and back."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle import arms
from tests.oracle.craig import PANDA, PANDA_FLANGE_MM, craig_tips
from tests.small_study import says
from tests.urdf_texts import poses

from ulna import Arm, Joint, Probe, UlnaInputError
from ulna.arm.frames.modified import from_modified, to_modified
from ulna.exchange.importers.robots import panda

angle, length = st.floats(-3, 3), st.floats(-500, 500)
row = st.tuples(angle, length, angle, length, st.sampled_from([1, -1]))


@given(st.lists(row, min_size=2, max_size=8), st.tuples(length, length, length))
def test_any_table(rows: list[tuple[float, float, float, float, int]], tip: tuple[float, float, float]) -> None:
    alpha, a, theta0, d, sign = zip(*rows, strict=True)
    q_rad = poses(len(rows), 10)
    joints = [Joint(t, al, le, of, sign=s) for al, le, t, of, s in rows]
    links, probes, t_table_base = from_modified(joints, {"p": Probe(*tip), "q": Probe(0.0, 0.0, 0.0, 5.0)})
    arm = Arm("craig", links, probes)
    for name, point in (("p", tip), ("q", (0.0, 0.0, 0.0))):
        tips = arm.tip(q_rad, name) @ t_table_base[:3, :3].T + t_table_base[:3, 3]
        assert np.abs(tips - craig_tips(alpha, a, theta0, d, sign, point, q_rad)).max() < 1e-9
    assert probes["q"].ball_mm == 5.0
    back = to_modified(links)
    assert [(j.alpha_rad, j.a_mm) for j in back] == [(0.0, 0.0), *((r[0], r[1]) for r in rows[1:])]
    assert [(j.theta0_rad, j.d_mm, j.sign) for j in back[:-1]] == [(r[2], r[3], r[4]) for r in rows[:-1]]


def test_the_panda_is_its_makers_table() -> None:
    q_rad = poses(7)
    tip = (0.0, 0.0, PANDA_FLANGE_MM + 103.4 + 30.0)
    expected = craig_tips(PANDA["alpha"], PANDA["a"], [0.0] * 7, PANDA["d"], [1] * 7, tip, q_rad)
    assert np.abs(panda().tip(q_rad) - expected).max() < 1e-9
    # numbers of a data sheet stay those of the data sheet
    assert [joint.d_mm for joint in panda().joints] == [333.0, 0.0, 316.0, 0.0, 384.0, 0.0, 0.0]
    assert [joint.a_mm for joint in panda().joints] == [0.0, 0.0, 82.5, -82.5, 0.0, 88.0, 0.0]
    assert panda().probes["ball"].tip_mm.tolist() == [0.0, 0.0, 240.4]


def test_no_beta_in_a_modified_table() -> None:
    chain = arms.parallel_axes()
    hayati = Joint(0.1, 0.2, 30.0, beta_rad=chain.last[1], model="hayati")
    with pytest.raises(ValueError, match="no beta"):
        to_modified([hayati, Joint()])
    flat = Joint(0.1, 0.2, 30.0, model="hayati", name="elbow")
    assert to_modified([flat, Joint()]) == [Joint(0.1, name="elbow"), Joint(0.0, 0.2, 30.0)]


ARM = """\
format = "ulna-arm/1"
name = "Craig's"
convention = "modified-dh"
units = { length = "m", angle = "deg" }

[[joint]]
name = "waist"
theta0 = 10.0
alpha = 0.0
a = 0.0
d = 0.5
limits = [-100, 90]

[[joint]]
theta0 = -20.0
alpha = -90.0
a = 0.1
d = 0.02
sign = -1

[[joint]]
theta0 = 30.0
alpha = 85.0
a = 0.4
d = 0.03
counts_per_turn = 4096

[probe.bent]
tip = { theta0 = 5.0, r = 0.04, h = 0.2 }
ball = 0.006

[probe.straight]
tip = { x = 0.0, y = 0.0, z = 0.25 }
"""


def _load(tmp_path: Path, text: str = ARM) -> Arm:
    path = tmp_path / "arm.toml"
    path.write_text(text)
    return Arm.load(path)


def test_an_arm_file_in_the_modified_form(tmp_path: Path) -> None:
    arm = _load(tmp_path)
    q_rad = poses(3)
    angles = [np.radians([0.0, -90.0, 85.0]), [0.0, 100.0, 400.0], np.radians([10.0, -20.0, 30.0]), [500.0, 20.0, 30.0]]
    bent = (40.0 * math.cos(math.radians(5)), -40.0 * math.sin(math.radians(5)), 200.0)
    for name, tip in (("bent", bent), ("straight", (0.0, 0.0, 250.0))):
        assert np.abs(arm.tip(q_rad, name) - craig_tips(*angles, [1, -1, 1], tip, q_rad)).max() < 1e-9
    # names are those of Ulna's form: row 2's twist and length stand after joint 1, the last row is in the tips
    values = dict(zip(arm.parameter_names, arm.parameters.tolist(), strict=True))
    assert values["joint.1.alpha"] == math.radians(-90)
    assert (values["joint.1.a"], values["joint.2.a"], values["joint.2.d"]) == (100.0, 400.0, 20.0)
    assert "joint.3.theta0" not in values
    theta0_rad, r_mm, h_mm = arm.probes["bent"].cylindrical
    assert (theta0_rad, r_mm, h_mm) == pytest.approx((math.radians(35), 40.0, 230.0))
    first, second, last = arm.joints
    assert (first.name, first.limits_rad) == ("waist", pytest.approx((math.radians(-100), math.pi / 2)))
    assert (second.sign, last.counts_per_turn, arm.probes["bent"].ball_mm) == (-1, 4096.0, 6.0)
    assert Arm.load(_saved(arm, tmp_path)) == arm


def _saved(arm: Arm, tmp_path: Path) -> Path:
    arm.save(tmp_path / "saved.toml")
    assert "convention" not in (tmp_path / "saved.toml").read_text()
    return tmp_path / "saved.toml"


def test_the_convention_that_is_not_said_is_ulnas_own(tmp_path: Path) -> None:
    plain = ARM.replace('convention = "modified-dh"\n', "")
    plain = plain.replace("theta0 = 30.0\nalpha = 85.0\na = 0.4\nd = 0.03\n", "")
    said = plain.replace("units", 'convention = "dh"\nunits')
    assert _load(tmp_path, plain) == _load(tmp_path, said)
    assert _load(tmp_path, plain).joints[1].a_mm == 100.0


BAD: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "an unknown convention": ('"modified-dh"', '"craig"', ("'convention'", "'craig'", "'dh' or 'modified-dh'")),
    "a Hayati joint": (
        "alpha = -90.0",
        'model = "hayati"\nalpha = -90.0',
        ("'joint.2.model'", "'hayati'", "modified form does not have", 'convention = "dh"', "ulna import dh"),
    ),
    "a beta": ("d = 0.02", "beta = 0.02", ("'joint.2.beta'", "got 0.02", "modified form does not have")),
    "a gap": ("d = 0.02\n", "", ("'joint.2.d' is missing", "the last one too", "Add it")),
    "a gap in the last row": ("theta0 = 30.0\n", "", ("'joint.3.theta0' is missing", "the last one too")),
    "a base that is moved": (
        "a = 0.0\nd = 0.5",
        "a = 0.15\nd = 0.5",
        ("'joint.1.a'", "got 0.15", "base frame", "expected 0", "Set both to 0", "a shift a along x"),
    ),
    "a base that is turned": ("alpha = 0.0", "alpha = 90.0", ("'joint.1.alpha'", "got 90", "base frame")),
}


@pytest.mark.parametrize("case", BAD)
def test_what_a_modified_arm_file_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = BAD[case]
    assert old in ARM
    with pytest.raises(UlnaInputError) as caught:
        _load(tmp_path, ARM.replace(old, new, 1))
    says(str(caught.value), f"{tmp_path / 'arm.toml'}: ", *fragments)
