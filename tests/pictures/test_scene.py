"""What is drawn of an arm is where the model says: tips as the core's, angles and lengths as the parameters."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.pictures.arms import arms, random_arm

from ulna.arm.arm import Arm
from ulna.arm.frames.bodies import bodies, constant_transforms
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.errors import UlnaInputError
from ulna.pictures.poses import pose_of, start_pose, typical
from ulna.pictures.scene import Scene, round_step, scene
from ulna.pictures.shapes import Shape, at


def of(drawn: Scene, role: str, joint: int) -> list[Shape]:
    return [shape for shape in drawn.shapes if shape.role == role and shape.joint == joint]


@pytest.mark.parametrize("arm", arms(), ids=lambda arm: f"{arm.name}, {arm.n} joints, full {arm.full_last_link}")
def test_the_tip_is_where_the_core_puts_it(arm: Arm) -> None:
    rng = np.random.default_rng(7)
    for name in arm.probes:
        drawn = scene(arm, name)
        for q_rad in rng.uniform(-6.0, 6.0, (25, arm.n)):
            expected_mm = arm.tip(q_rad, name)
            assert np.abs(drawn.tip_mm(q_rad) - expected_mm).max() < 1e-9
            (ball,) = [shape for shape in drawn.shapes if shape.kind == "ball"]
            assert np.abs(at(bodies(arm, q_rad)[ball.body], ball.points_mm)[0] - expected_mm).max() < 1e-9


def test_no_constant_transform_knows_an_encoder() -> None:
    """A product of them with turns about z alone is the whole map: signs and angles stand nowhere else."""
    arm = random_arm(3, 6)
    constant = constant_transforms(arm)
    assert len(constant) == arm.n + 1
    assert (constant[0] == np.eye(4)).all()
    turned = bodies(arm, np.zeros(arm.n))
    for k in range(arm.n):
        assert np.allclose(turned[k + 1], turned[k] @ constant[k], atol=1e-9)


def test_the_arc_of_alpha_ends_on_the_next_axis() -> None:
    arm = random_arm(5, 7)
    drawn = scene(arm)
    q_rad = np.random.default_rng(1).uniform(-3.0, 3.0, arm.n)
    stand = bodies(arm, q_rad)
    for k, joint in enumerate(arm.joints[:-1], start=1):
        if joint.model == "hayati":
            continue
        arcs = of(drawn, "angle", k)
        alpha = arcs[[shape.text for shape in of(drawn, "angle-name", k)].index("alpha")]
        points = at(stand[k], alpha.points_mm)
        end = stand[k + 1][:3, 3]  # on axis k + 1, where link k ends
        begin, last = (each / np.linalg.norm(each) for each in (points[0] - end, points[-1] - end))
        assert begin @ stand[k][:3, 2] == pytest.approx(1.0, abs=1e-9), "it begins along this axis"
        assert last @ stand[k + 1][:3, 2] == pytest.approx(1.0, abs=1e-9), "and ends along the next"
        assert math.acos(begin @ last) == pytest.approx(abs(math.remainder(joint.alpha_rad, math.tau)), abs=1e-7)


def test_lengths_are_drawn_as_long_as_they_are() -> None:
    arm = random_arm(6, 6)
    drawn = scene(arm)
    for k, joint in enumerate(arm.joints[:-1], start=1):
        names = [shape.text for shape in of(drawn, "length-name", k)]
        lines = [float(np.linalg.norm(np.diff(shape.points_mm, axis=0))) for shape in of(drawn, "length", k)]
        found = dict(zip(names, lines, strict=True))
        expected = {"a": abs(joint.a_mm)} | ({"d": abs(joint.d_mm)} if joint.model == "dh" else {})
        assert found == pytest.approx(expected)


def test_what_is_zero_has_no_dimension() -> None:
    arm = Arm("straight", (Joint(0.0, 0.0, 100.0, 0.0), Joint()), {"tip": Probe(0.0, 0.0, 50.0)})
    assert {shape.text for shape in scene(arm).shapes if shape.group == "dimensions" and shape.text} == {"a"}


@pytest.mark.parametrize("sign", [1, -1])
def test_the_arrow_about_an_axis_turns_as_the_arm_does_when_the_encoder_counts_up(sign: int) -> None:
    arm = Arm("two", (Joint(0.4, 1.2, 100.0, 80.0, sign=sign), Joint()), {"tip": Probe(20.0, 0.0, 50.0)})
    drawn = scene(arm)
    (line,) = of(drawn, "sense", 1)
    first, second = line.points_mm[:2]  # in the base, whose z is axis 1
    turned = first[0] * second[1] - first[1] * second[0]
    before, after = arm.tip([0.0, 0.3]), arm.tip([0.05, 0.3])
    moved = before[0] * after[1] - before[1] * after[0]
    assert np.sign(turned) == np.sign(moved) == sign


def test_a_sign_that_nobody_knows_has_no_arrow() -> None:
    arm = Arm("two", (Joint(0.4, 1.2, 100.0, 80.0, sign=0), Joint()), {"tip": Probe(20.0, 0.0, 50.0)})
    assert of(scene(arm), "sense", 1) == []
    assert len(of(scene(arm), "sense", 2)) == 1


def test_every_frame_and_axis_has_its_name() -> None:
    arm = random_arm(2, 6, full=True)
    words = [shape.text for shape in scene(arm).shapes if shape.kind == "word"]
    assert {f"{axis}{k}" for axis in "xyz" for k in range(arm.n + 1)} <= set(words)
    assert {str(k) for k in range(1, arm.n + 1)} <= set(words)
    assert "bent" in words


def test_a_probe_that_there_is_not_is_refused() -> None:
    with pytest.raises(UlnaInputError, match=r"no probe 'bnt'\. Did you mean 'bent'"):
        scene(random_arm(0, 3), "bnt")


def test_steps_are_round() -> None:
    for about in np.random.default_rng(0).uniform(-4.0, 5.0, 200):
        step = round_step(10.0**about)
        assert 0.39 < step / 10.0**about <= 1.0 + 1e-9
        assert float(f"{step:.0e}") == pytest.approx(step)
        assert f"{step:.0e}"[0] in "125"


def test_the_start_pose_is_within_limits() -> None:
    joints = (Joint(limits_rad=(-1.0, 2.0)), Joint(limits_rad=(0.5, 1.5)), Joint(endless=True), Joint())
    arm = Arm("limits", joints, {"tip": Probe(0.0, 0.0, 1.0)})
    assert start_pose(arm).tolist() == [0.0, 1.0, 0.0, 0.0]


def test_the_typical_pose_is_one_of_them_and_no_outlier_is_it() -> None:
    rng = np.random.default_rng(4)
    poses = rng.normal(0.0, 0.3, (200, 6)) + np.arange(6)
    poses[13] += 40.0
    k = typical(poses)
    spread = np.abs(poses - np.median(poses, axis=0)).max(axis=1)
    assert spread[k] < np.median(spread)
    assert typical(poses[:1]) == 0


def test_a_pose_is_read_as_people_write_it() -> None:
    arm = random_arm(0, 3)
    for text in ("10,-20.5,30", " 10 -20.5 30 ", "10; -20.5; 30", "1e1,-20.5,30"):
        assert np.allclose(np.degrees(pose_of(text, arm)), [10.0, -20.5, 30.0])
    for text, said in (("1,2", "got 2 angles"), ("1,2,3,4", "got 4"), ("1,x,3", "'x' as angle 2"), ("", "got 0")):
        with pytest.raises(UlnaInputError, match=said):
            pose_of(text, arm)
    for text in ("nan,0,0", "inf,0,0"):
        with pytest.raises(UlnaInputError, match="as angle 1"):
            pose_of(text, arm)
