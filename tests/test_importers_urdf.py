"""A drawing as an arm is the same map, whatever its axes do."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ulna import UlnaInputError
from ulna.importers.robots import panda, ur10
from ulna.importers.urdf import Step, arm_from_chain, chain_tip, read_chain, turn

DRAWINGS = Path(__file__).parents[2] / "shared" / "data" / "mukca" / "nominal_urdf"
needs_drawings = pytest.mark.skipif(not DRAWINGS.is_dir(), reason="the drawings of ../shared/data are not there")


def _poses(n: int, count: int = 200) -> NDArray[np.float64]:
    return np.random.default_rng(n).uniform(-3, 3, (count, n))


@needs_drawings
@pytest.mark.shared_data
@pytest.mark.parametrize(("name", "joints", "hayati"), [("panda", 7, []), ("iiwa14", 7, []), ("gen3lite", 6, [2])])
def test_an_arm_from_a_drawing_is_the_drawn_chain(name: str, joints: int, hayati: list[int]) -> None:
    path = DRAWINGS / f"{name}.urdf"
    _, steps = read_chain(path)
    arm = arm_from_chain(name, steps, path)
    assert arm.n == joints
    assert [k for k, joint in enumerate(arm.joints, start=1) if joint.model == "hayati"] == hayati
    q_rad = _poses(joints)
    assert np.abs(arm.tip(q_rad) - chain_tip(steps, q_rad)).max() < 1e-9


@needs_drawings
@pytest.mark.shared_data
def test_the_panda_of_the_data_sheet_is_the_panda_of_the_drawing() -> None:
    _, steps = read_chain(DRAWINGS / "panda.urdf", "panda_hand_tcp")
    arm = panda()
    q_rad = _poses(7)
    hand = arm.with_parameters([*arm.parameters[:-1], 107.0 + 103.4])
    assert np.abs(hand.tip(q_rad) - chain_tip(steps, q_rad)).max() < 1e-9
    assert [joint.limits_rad for joint in arm.joints] == [step.limits_rad for step in steps if step.axis is not None]


def test_the_ur10_stands_where_its_data_sheet_says() -> None:
    # At zero angles a UR's upper arm and forearm lie along -x, and its wrist hangs off to -y and down.
    arm = ur10()
    z_mm = arm.probes["target"].z_mm
    assert arm.tip(np.zeros(6)) == pytest.approx([-612.7 - 571.6, -163.9 - z_mm, 128.0 - 115.7], abs=1e-9)
    # Joints 2, 3 and 4 are parallel: their sum keeps the hand's direction, so folding 2 against 4 only shifts it.
    a = arm.tip([0.3, 0.4, 0.5, -0.9, 0.6, 0.7]) - arm.tip([0.3, 0.4, -0.2, -0.2, 0.6, 0.7])
    b = arm.tip([0.3, 0.4, 0.5, -0.9, -1.6, 0.1]) - arm.tip([0.3, 0.4, -0.2, -0.2, -1.6, 0.1])
    assert a == pytest.approx(b, abs=1e-9)


angle = st.floats(-math.pi, math.pi)
offset = st.floats(-500, 500)
step = st.tuples(st.tuples(angle, angle, angle), st.tuples(offset, offset, offset), st.sampled_from("xyz"))


@given(st.lists(step, min_size=2, max_size=7))
def test_any_chain(chain: list[tuple[tuple[float, ...], tuple[float, ...], str]]) -> None:
    steps = []
    for k, ((roll, pitch, yaw), xyz, axis) in enumerate(chain):
        t = np.eye(4)
        t[:3, :3] = turn("z", yaw) @ turn("y", pitch) @ turn("x", roll)
        t[:3, 3] = xyz
        steps.append(Step(f"j{k}", np.eye(4) if k == 0 else t, np.eye(3)["xyz".index("z" if k == 0 else axis)]))
    tool = np.eye(4)
    tool[:3, 3] = (10.0, 20.0, 30.0)
    steps.append(Step("tool", tool, None))
    arm = arm_from_chain("any", steps, Path("any.urdf"))
    q_rad = _poses(len(chain), 5)
    # Common normals of nearly parallel axes are far away: what is lost to rounding grows with them.
    farthest_mm = max(1000.0, *(abs(joint.d_mm) for joint in arm.joints))
    assert np.abs(arm.tip(q_rad) - chain_tip(steps, q_rad)).max() < 1e-12 * farthest_mm


URDF = """<?xml version="1.0"?>
<robot name="two">
  <joint name="j1" type="revolute">
    <parent link="base"/><child link="l1"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="j2" type="continuous">
    <parent link="l1"/><child link="l2"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="t" type="fixed"><parent link="l2"/><child link="ball_link"/><origin xyz="0 0 0.3"/></joint>
</robot>
"""


def test_a_drawing_in_metres_becomes_mm(tmp_path: Path) -> None:
    path = tmp_path / "two.urdf"
    path.write_text(URDF)
    name, steps = read_chain(path)
    arm = arm_from_chain(name, steps, path)
    assert (arm.name, arm.n) == ("two", 2)
    assert arm.tip([0.0, 0.0]) == pytest.approx([200, 0, 400], abs=1e-9)
    assert arm.tip([math.pi / 2, math.pi / 2]) == pytest.approx([0, 500, 100], abs=1e-9)


BAD: dict[str, tuple[str, str, str]] = {
    "no XML": ("<robot", "<robot <", "not valid XML"),
    "no robot": ("robot", "sdf", "outermost element is <sdf>"),
    "no child": ('<child link="l1"/>', "", "joint 'j1' names no child link"),
    "sliding": ("continuous", "prismatic", "joint 'j2' is of type 'prismatic'"),
    "one joint": ("continuous", "fixed", "there are 1 rotary joints"),
    "two numbers": ('"0.2 0 0"', '"0.2 0"', r"joint 'j2', xyz: got '0.2 0', expected three numbers"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_a_drawing_is_told(tmp_path: Path, case: str) -> None:
    old, new, message = BAD[case]
    path = tmp_path / "two.urdf"
    path.write_text(URDF.replace(old, new))
    with pytest.raises(UlnaInputError, match=message) as caught:
        arm_from_chain("two", read_chain(path)[1], path)
    assert str(caught.value).startswith(str(path))


def test_an_unknown_link(tmp_path: Path) -> None:
    path = tmp_path / "two.urdf"
    path.write_text(URDF)
    with pytest.raises(UlnaInputError, match=r"no link 'bal_link' below a joint\. Did you mean 'ball_link'\?"):
        read_chain(path, "bal_link")
