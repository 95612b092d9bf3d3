"""A robot's description as an arm is the same map, in the same frame, whatever its axes do."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from tests.oracle.drawn import drawn_tips
from tests.urdf_texts import Made, chains, poses, tips_in_root, urdf, write

from ulna import Arm
from ulna.importers.robots import panda, ur10
from ulna.importers.urdf import import_urdf
from ulna.urdf.arm import arm_from_chain
from ulna.urdf.chain import read_chain

DRAWINGS = Path(__file__).parents[2] / "shared" / "data" / "mukca" / "nominal_urdf"
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
