"""A robot's description as an arm is the same map, in the same frame, whatever its axes do."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import Rotation
from tests.oracle.drawn import drawn_tips
from tests.urdf_texts import Made, chains, chains_that_slide, poses, tips_in_root, urdf, write

from ulna import Arm, UlnaInputError
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.exchange.importers.robots import panda, ur10
from ulna.exchange.importers.urdf import import_urdf
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain

DRAWINGS = Path(__file__).parents[3] / "shared" / "data" / "mukca" / "nominal_urdf"
needs_drawings = pytest.mark.skipif(not DRAWINGS.is_dir(), reason="the drawings of ../shared/data are not there")


@needs_drawings
@pytest.mark.shared_data
@pytest.mark.parametrize(("name", "joints", "hayati"), [("panda", 7, []), ("iiwa14", 7, []), ("gen3lite", 6, [2])])
def test_an_arm_from_a_real_description_is_the_drawn_chain(name: str, joints: int, hayati: list[int]) -> None:
    path = DRAWINGS / f"{name}.urdf"
    arm, t_root_base = arm_from_chain(read_chain(path))
    assert arm.n == joints
    assert [k for k, joint in enumerate(arm.joints, start=1) if joint.model == "hayati"] == hayati
    q_rad = poses(joints)
    assert np.abs(arm.tip(q_rad) - drawn_tips(path, "ball_link", q_rad)).max() < 1e-9
    assert np.array_equal(t_root_base, np.eye(4))


@needs_drawings
@pytest.mark.shared_data
def test_the_panda_of_the_data_sheet_is_the_panda_of_the_description() -> None:
    path = DRAWINGS / "panda.urdf"
    arm = panda()
    q_rad = poses(7)
    hand = arm.with_parameters([*arm.parameters[:-1], 107.0 + 103.4])
    assert np.abs(hand.tip(q_rad) - drawn_tips(path, "panda_hand_tcp", q_rad)).max() < 1e-9
    assert [joint.limits_rad for joint in arm.joints] == [step.limits_rad for step in read_chain(path).turning]


def test_the_ur10_stands_where_its_data_sheet_says() -> None:
    # At zero angles a UR's upper arm and forearm lie along -x, and its wrist hangs off to -y and down.
    arm = ur10()
    z_mm = arm.probes["target"].z_mm
    assert arm.tip(np.zeros(6)) == pytest.approx([-612.7 - 571.6, -163.9 - z_mm, 128.0 - 115.7], abs=1e-9)
    # Joints 2, 3 and 4 are parallel: their sum keeps the hand's direction, so folding 2 against 4 only shifts it.
    a = arm.tip([0.3, 0.4, 0.5, -0.9, 0.6, 0.7]) - arm.tip([0.3, 0.4, -0.2, -0.2, 0.6, 0.7])
    b = arm.tip([0.3, 0.4, 0.5, -0.9, -1.6, 0.1]) - arm.tip([0.3, 0.4, -0.2, -0.2, -1.6, 0.1])
    assert a == pytest.approx(b, abs=1e-9)


@given(chains)
def test_any_chain(tmp_path_factory: pytest.TempPathFactory, made: list[Made]) -> None:
    path = write(tmp_path_factory.mktemp("urdf"), urdf(made))
    arm, t_root_base = arm_from_chain(read_chain(path))
    q_rad = poses(arm.n, 5)
    assert np.abs(tips_in_root(arm, t_root_base, q_rad) - drawn_tips(path, "tip", q_rad)).max() < 1e-9
    assert np.abs(t_root_base[:3, :3].T @ t_root_base[:3, :3] - np.eye(3)).max() < 1e-14


@given(chains_that_slide)
def test_any_chain_that_slides(tmp_path_factory: pytest.TempPathFactory, made: list[Made]) -> None:
    """In every pose the drawn tip, to rounding: of a prismatic joint the arm has an axis of the same direction."""
    path = write(tmp_path_factory.mktemp("urdf"), urdf(made))
    arm, t_root_base = arm_from_chain(read_chain(path, "tip"))
    slides = [joint.slides for joint in made if joint.axis is not None]
    assert [joint.slides for joint in arm.joints] == slides
    assert all(joint.limits_rad == pytest.approx((-100.0, 400.0)) for joint in arm.joints if joint.slides)
    q_rad = np.where(slides, 100.0, 1.0) * poses(arm.n, 5)
    assert np.abs(tips_in_root(arm, t_root_base, q_rad) - drawn_tips(path, "tip", q_rad)).max() < 1e-9


UP, DOWN, ASIDE = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
S, C = math.sin(0.02), math.cos(0.02)
HERE, STRAIGHT, OUT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.3, 0.0, 0.0)


def _arm(tmp_path: Path, first: Made, second_axis: tuple[float, float, float] = ASIDE) -> tuple[Arm, np.ndarray]:
    return arm_from_chain(read_chain(write(tmp_path, urdf([first, Made(OUT, STRAIGHT, second_axis)]))))


@pytest.mark.parametrize(
    ("first", "sign", "shift_mm", "turn_rad"),
    [
        (Made((0.0, 0.0, 0.2), STRAIGHT, UP), 1, HERE, 0.0),
        (Made((0.0, 0.0, 0.2), STRAIGHT, DOWN), -1, HERE, 0.0),  # clockwise: the frame stays, the sign tells
        (Made((0.0, 0.0, 0.2), (math.pi, 0.0, 0.0), UP), -1, HERE, 0.0),  # the same, said with the frame
        (Made((0.5, 0.4, 0.8), (0.0, 0.0, 0.7), UP), 1, (500.0, 400.0, 0.0), 0.0),  # on a table: no height is lost
        (Made((0.1, 0.2, 0.3), STRAIGHT, (1.0, 0.0, 0.0)), 1, (0.0, 200.0, 300.0), math.pi / 2),  # on a wall
        (
            Made((0.0, 0.0, 0.2), (0.02, 0.0, 0.0), DOWN),
            -1,
            (0.0, 100 * math.sin(0.04), 200 * math.sin(0.02) ** 2),
            0.02,
        ),
        (Made(HERE, (2.0, 0.0, 0.0), UP), 1, HERE, 2.0),
    ],
)
def test_where_the_base_frame_stands(
    tmp_path: Path, first: Made, sign: int, shift_mm: tuple[float, ...], turn_rad: float
) -> None:
    arm, t = _arm(tmp_path, first)
    assert arm.joints[0].sign == sign
    assert t[:3, 3] == pytest.approx(shift_mm, abs=1e-9)
    assert math.acos(min(1.0, (np.trace(t[:3, :3]) - 1) / 2)) == pytest.approx(turn_rad, abs=1e-8)


def test_an_axis_the_other_way_is_geometry(tmp_path: Path) -> None:
    first = Made((0.0, 0.0, 0.2), STRAIGHT, UP)
    there, back = (_arm(tmp_path, first, (0.0, way, 0.0))[0] for way in (1.0, -1.0))
    assert [joint.sign for joint in (*there.joints, *back.joints)] == [1] * 4
    assert there.joints[0].alpha_rad == pytest.approx(-back.joints[0].alpha_rad)
    assert there.tip([0.4, 0.5]) == pytest.approx(back.tip([0.4, -0.5]), abs=1e-9)


@pytest.mark.parametrize(
    ("axis", "rpy", "model"),
    [
        (UP, STRAIGHT, "hayati"),
        (DOWN, STRAIGHT, "hayati"),
        (UP, (0.049, 0.0, 0.0), "hayati"),
        (UP, (0.051, 0.0, 0.0), "dh"),
        (UP, (math.pi - 0.049, 0.0, 0.0), "hayati"),
        (ASIDE, STRAIGHT, "dh"),
    ],
)
def test_parallel_axes_are_hayati_joints(
    tmp_path: Path, axis: tuple[float, float, float], rpy: tuple[float, float, float], model: str
) -> None:
    made = [Made(HERE, STRAIGHT, UP), Made(OUT, rpy, axis), Made((0.0, 0.3, 0.1), STRAIGHT, (1.0, 0.0, 0.0))]
    arm, _ = arm_from_chain(read_chain(write(tmp_path, urdf(made))))
    assert arm.joints[0].model == model
    assert arm.joints[0].a_mm == pytest.approx(300, abs=1)


def test_rounding_does_not_choose_the_side_of_a_common_normal(tmp_path: Path) -> None:
    # The normal of z and x is y, a quarter turn from zero offset either way: noise must not decide.
    found = set()
    for noise in (0.0, 1e-16, -1e-16):
        made = [Made(HERE, STRAIGHT, UP), Made((0.2, 0.1, 0.0), (0.0, math.pi / 2, noise), UP)]
        arm, _ = arm_from_chain(read_chain(write(tmp_path, urdf(made))))
        found.add(round(arm.joints[0].theta0_rad, 9))
    assert found == {round(-math.pi / 2, 9)}


def test_the_file_says_where_the_base_frame_is(tmp_path: Path) -> None:
    text = urdf([Made((0.1, 0.2, 0.3), STRAIGHT, (1.0, 0.0, 0.0)), Made(OUT, STRAIGHT, ASIDE)], base="wall\u00b7x")
    found = import_urdf(write(tmp_path, text), tmp_path / "arm.toml")
    written = (tmp_path / "arm.toml").read_text()
    assert written.startswith(
        "# Made of made.urdf, from link 'wall·x' to link 'tip'.\n# The arm's base frame stands on"
    )
    assert "xyz = 0, 200, 300 mm, turned by rpy = 0, 1.57079633, 0 rad" in written
    assert Arm.load(tmp_path / "arm.toml") == found.arm
    straight = urdf([Made(HERE, STRAIGHT, UP), Made(OUT, STRAIGHT, ASIDE)], base="a&#10;b = 5 &#x7f;")
    assert import_urdf(write(tmp_path, straight), tmp_path / "b.toml").remark.startswith("The arm's base frame is that")
    assert tomllib.loads((tmp_path / "b.toml").read_text())["name"] == "made"


MASSES = """<robot name="weighed">
  <link name="base"><inertial><mass value="9"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0.1 0.02 0.03" rpy="0.3 0 0"/><mass value="2.5"/></inertial></link>
  <link name="box"><inertial><origin xyz="0 0 0.05"/><mass value="0.5"/></inertial></link>
  <link name="hand"><inertial><mass value="1.25"/></inertial></link>
  <link name="finger"><inertial><origin xyz="0.01 0 0"/><mass value="0.25"/></inertial></link>
  <link name="ball_link"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0.05 0 0.3" rpy="0.2 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="glued" type="fixed"><parent link="arm"/><child link="box"/><origin xyz="0 0.2 0" rpy="0 1.1 0"/></joint>
  <joint name="bend" type="revolute"><parent link="arm"/><child link="hand"/>
    <origin xyz="0.4 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/>
    <origin xyz="0 0 0.1"/><axis xyz="1 0 0"/></joint>
  <joint name="tip" type="fixed"><parent link="hand"/><child link="ball_link"/><origin xyz="0.02 0.03 0.2"/></joint>
</robot>
"""


def test_masses_come_along_with_what_hangs_on_each_joint(tmp_path: Path) -> None:
    """The arm has its links' masses where the drawing has them, in every pose: fixed and gripping parts too."""
    path = write(tmp_path, MASSES)
    arm, t_root_base = arm_from_chain(read_chain(path))
    first, second = (joint.effects for joint in arm.joints)
    assert (first.mass_kg, second.mass_kg) == (3.0, 1.5)
    q_rad = poses(2, 20)
    # the drawing's chain up to each link, and the masses there, by hand
    turned = [Rotation.from_euler("xyz", [0.2, 0, 0]) * Rotation.from_rotvec([0, 0, q]) for q, _ in q_rad]
    box = Rotation.from_euler("xyz", [0, 1.1, 0]).apply([0, 0, 0.05]) + np.array([0, 0.2, 0])
    of_arm = (2.5 * np.array([0.1, 0.02, 0.03]) + 0.5 * box) / 3.0
    of_hand = (1.25 * np.zeros(3) + 0.25 * np.array([0.01, 0, 0.1])) / 1.5
    stand, elbow = np.array([0.05, 0, 0.3]), np.array([0.4, 0, 0])
    expected = [
        np.stack([turn.apply(of_arm) + stand for turn in turned]),
        np.stack(
            [
                turn.apply(Rotation.from_rotvec([0, q, 0]).apply(of_hand) + elbow) + stand
                for turn, (_, q) in zip(turned, q_rad, strict=True)
            ]
        ),
    ]
    # the arm's frames after its links, told by tips: a probe at the centre, on an arm that ends there
    at_hand = replace(arm, probes={"centre": Probe(*second.centre_mm)})
    assert np.abs(tips_in_root(at_hand, t_root_base, q_rad) - 1000 * expected[1]).max() < 1e-5
    at_arm = replace(at_hand, joints=(arm.joints[0], Joint()), probes={"centre": Probe(*first.centre_mm)})
    still = np.stack([q_rad[:, 0], np.zeros(20)], axis=1)
    assert np.abs(tips_in_root(at_arm, t_root_base, still) - 1000 * expected[0]).max() < 1e-5
    # gravity pulls down the drawing's z
    assert t_root_base[:3, :3] @ arm.gravity == pytest.approx([0, 0, -1])


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('<mass value="2.5"/>', '<mass value="heavy"/>', "link 'arm', value: got 'heavy', expected a number"),
        ('<mass value="2.5"/>', '<mass value="-2"/>', "link 'arm', value: got '-2', expected 0 or more"),
        ('xyz="0.1 0.02 0.03"', 'xyz="0.1 0.02"', "link 'arm', xyz: got '0.1 0.02', expected three numbers"),
    ],
)
def test_masses_that_are_none(tmp_path: Path, old: str, new: str, told: str) -> None:
    assert MASSES.count(old) == 1
    with pytest.raises(UlnaInputError, match=re.escape(told)):
        read_chain(write(tmp_path, MASSES.replace(old, new)))
