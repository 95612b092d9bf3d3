"""A calibrated arm put into the URDF that it was drawn in: the same tips, and nothing else in the file is touched."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.drawn import drawn_frames, drawn_joints, drawn_tips
from tests.small_study import says
from tests.urdf_texts import Made, chains, poses, tips_in_root, urdf, write

from ulna import Arm, Probe, UlnaInputError
from ulna.arm.frames.links import link_at_zero, link_between
from ulna.exchange.export.template import Filled, export_template, remarks, summary
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain

DRAWINGS = Path(__file__).parents[3] / "shared" / "data" / "mukca" / "nominal_urdf"
needs_drawings = pytest.mark.skipif(not DRAWINGS.is_dir(), reason="the drawings of ../shared/data are not there")


def moved(arm: Arm, size: float = 1.0, seed: int = 3) -> Arm:
    """An arm as calibration might find it: some mrad and mm beside."""
    scale = np.array([3e-3 if unit == "rad" else 2.0 for unit in arm.parameter_units])
    return arm.with_parameters(arm.parameters + size * scale * np.random.default_rng(seed).normal(size=len(scale)))


def without_numbers(content: bytes) -> bytes:
    """A file less the values of its origins."""
    return re.sub(rb"""\b(xyz|rpy)=("[^"]*"|'[^']*')""", rb"\1", content)


def check(path: Path, arm: Arm, tip_link: str, probe: str = "ball") -> Filled:
    """Filled with an arm, the template has that arm's tips."""
    _, t_root_base = arm_from_chain(read_chain(path, tip_link))
    filled = export_template(path, arm, probe, tip_link)
    out = path.with_name("filled.urdf")
    out.write_bytes(filled.content)
    q_rad = poses(arm.n, 20)
    expected = tips_in_root(arm, t_root_base, q_rad, probe)
    assert np.abs(drawn_tips(out, tip_link, q_rad) - expected).max() < 1e-9
    again, t_again = arm_from_chain(read_chain(out, tip_link))
    assert np.abs(tips_in_root(again, t_again, q_rad) - expected).max() < 1e-9
    return filled


@needs_drawings
@pytest.mark.shared_data
@pytest.mark.parametrize("name", ["panda", "iiwa14", "gen3lite"])
def test_real_descriptions(tmp_path: Path, name: str) -> None:
    content = (DRAWINGS / f"{name}.urdf").read_bytes()
    path = tmp_path / "robot.urdf"
    path.write_bytes(content)
    arm, _ = arm_from_chain(read_chain(path))
    as_drawn = check(path, arm, "ball_link")
    assert as_drawn.content == content
    assert as_drawn.changes == []
    filled = check(path, moved(arm), "ball_link")
    assert without_numbers(filled.content) == without_numbers(content)
    turning = [joint.get("name") for joint in drawn_joints(path, "ball_link") if joint.get("type") == "revolute"]
    assert [change.joint for change in filled.changes] == [*turning, "ball_joint"]
    changed = [line for line in filled.content.splitlines() if line not in content.splitlines()]
    assert len(changed) == arm.n + 1
    assert all(change.shift_mm < 20 and change.turn_rad < 0.05 for change in filled.changes)


@given(chains, st.integers(0, 2**32 - 1), st.lists(st.booleans(), min_size=7, max_size=7))
def test_any_chain(tmp_path_factory: pytest.TempPathFactory, made: list[Made], seed: int, against: list[bool]) -> None:
    path = write(tmp_path_factory.mktemp("urdf"), urdf(made))
    arm, _ = arm_from_chain(read_chain(path))
    assert check(path, arm, "tip").content == path.read_bytes()
    found = moved(arm, seed=seed)
    filled = check(path, found, "tip")
    assert without_numbers(filled.content) == without_numbers(path.read_bytes())
    # encoders that count against the description
    joints = [replace(j, sign=-j.sign if other else j.sign) for j, other in zip(found.joints, against, strict=False)]
    filled = check(path, replace(found, joints=tuple(joints)), "tip")
    reversed_joints = [change.reversed_axis for change in filled.changes if change.joint in _turning(path)]
    if len(reversed_joints) == arm.n:
        assert reversed_joints == against[: arm.n]


def _turning(path: Path) -> list[str | None]:
    return [joint.get("name") for joint in drawn_joints(path, "tip") if joint.get("type") != "fixed"]


def test_an_equal_set_of_parameters_gives_the_same_file(tmp_path: Path) -> None:
    aside = (0.0, 1.0, 0.0)
    made = [Made((0.0, 0.0, 0.3), (0.0, 0.0, 0.2), (0.0, 0.0, 1.0)), Made((0.1, 0.05, 0.2), (0.3, 0.1, 0.0), aside)]
    made += [Made((0.2, 0.0, 0.1), (0.1, 0.0, 0.0), aside), Made((0.1, 0.0, 0.0), (1.0, 0.4, 0.3), aside)]
    path = write(tmp_path, urdf(made))
    arm = moved(arm_from_chain(read_chain(path))[0])
    one = check(path, arm, "tip")
    # the twin of joint 1 (a joint flip), and the last link told by its other common normal
    first, second = arm.joints[0], arm.joints[1]
    twin = replace(first, theta0_rad=first.theta0_rad + math.pi, alpha_rad=-first.alpha_rad, a_mm=-first.a_mm)
    other = check(
        path,
        replace(arm, joints=(twin, replace(second, theta0_rad=second.theta0_rad + math.pi), *arm.joints[2:])),
        "tip",
    )
    numbers = [
        np.array(
            [float(part) for part in re.findall(rb"[-+\d.e]+", b" ".join(re.findall(rb"=['\"]([-+\d.e ]+)", each)))]
        )
        for each in (one.content, other.content)
    ]
    assert np.abs(numbers[0] - numbers[1]).max() < 1e-9


def test_an_axis_told_the_other_way_round_is_the_same_axis(tmp_path: Path) -> None:
    aside = (0.0, 1.0, 0.0)
    made = [Made((0.0, 0.0, 0.3), (0.0, 0.0, 0.2), (0.0, 0.0, 1.0)), Made((0.1, 0.05, 0.2), (0.3, 0.1, 0.0), aside)]
    made += [Made((0.2, 0.0, 0.1), (0.1, 0.9, 0.0), aside), Made((0.1, 0.0, 0.0), (1.0, 0.4, 0.3), aside)]
    path = write(tmp_path, urdf(made))
    arm = arm_from_chain(read_chain(path))[0]
    for k in (1, 2):
        before, joint = arm.joints[k - 1], arm.joints[k]
        # z against the drawn axis, and the encoder against z: Rz(-t) = Rx(π) Rz(t) Rx(π)
        joints = list(arm.joints)
        joints[k - 1] = replace(before, alpha_rad=before.alpha_rad + math.pi)
        joints[k] = replace(
            joint, sign=-1, theta0_rad=-joint.theta0_rad, alpha_rad=joint.alpha_rad + math.pi, d_mm=-joint.d_mm
        )
        other = replace(arm, joints=tuple(joints))
        assert np.abs(other.tip(poses(4)) - arm.tip(poses(4))).max() < 1e-9
        filled = check(path, other, "tip")
        assert not any(change.reversed_axis for change in filled.changes)
        assert max((change.shift_mm for change in filled.changes), default=0.0) < 1e-9


def test_a_zero_offset_turns_its_own_joint_only(tmp_path: Path) -> None:
    made = [Made((0.0, 0.0, 0.3), (0.0, 0.0, 0.2), (0.0, 0.0, 1.0))]
    made += [Made((0.2, 0.0, 0.1), (0.1 * k, 1.0, 0.0), (0.0, 1.0, 0.0)) for k in range(3)]
    path = write(tmp_path, urdf(made))
    arm, _ = arm_from_chain(read_chain(path))
    names = arm.parameter_names
    for parameter, joint in (
        ("joint.2.theta0", "j1"),
        ("joint.2.d", "j1"),
        ("joint.2.a", "j2"),
        ("joint.2.alpha", "j2"),
    ):
        x = arm.parameters
        x[names.index(parameter)] += 0.01
        (change,) = check(path, arm.with_parameters(x), "tip").changes
        assert change.joint == joint, parameter
        shift_mm = 0.01 if parameter.endswith((".d", ".a")) else 0.0
        turn_rad = 0.0 if shift_mm else 0.01
        assert change.turn_rad == pytest.approx(turn_rad, abs=1e-9)
        if shift_mm:
            assert change.shift_mm == pytest.approx(shift_mm, abs=1e-9)


ODD = """<?xml version='1.0' encoding='ISO-8859-1'?>\r
<!-- a > in a comment, <origin xyz="9 9 9"/>, and an umlaut: \u00fc -->\r
<robot name="odd"><gazebo reference="l1"><origin xyz="8 8 8"/></gazebo>\r
\t<joint type="revolute" name='j>1'><!-- no origin, no axis: zero, and x -->
    <parent link="base"/><child link="l1"/><limit effort="1" velocity="2" lower="-1" upper="1"/></joint>
  <joint name="f" type="fixed"><parent link="l1"/><child link="f1"/><origin rpy="0 -1.5707963267948966 0"/></joint>
  <joint name="j2" type="continuous"><parent link="f1"/><child link="l2"/>
    <origin note=' xyz="7 7 7" '
            xyz = '0.2  1e-1
0' /><axis xyz='0 1.0 0'/></joint>
  <joint name="t" type="fixed"><parent link="l2"/><child link="tool"/><origin rpy="0 0 1"></origin></joint>
</robot><!-- the end -->"""


def test_the_file_is_edited_where_the_numbers_stand(tmp_path: Path) -> None:
    content = ODD.encode("latin-1")
    path = tmp_path / "odd.urdf"
    path.write_bytes(content)
    arm, _ = arm_from_chain(read_chain(path))
    assert check(path, arm, "tool").content == content
    found = moved(arm)
    found = replace(found, joints=tuple(replace(joint, sign=-joint.sign) for joint in found.joints))
    filled = check(path, found, "tool")
    assert [change.reversed_axis for change in filled.changes] == [True, True, False]
    added = re.compile(rb'(?<=name=\'j>1\'>)<origin( \w+="[^"]*"){1,2}/><axis xyz="-1 0 0"/>')
    assert added.search(filled.content)
    rest = added.sub(b"", filled.content)
    rest = re.sub(rb"xyz = '[^']*'", b"xyz = '0.2  1e-1\n0'", rest)
    rest = rest.replace(b'<origin rpy="0 0 1" xyz', b"<origin xyz")
    rest = re.sub(rb'<origin rpy="[^"]*" note', b"<origin note", rest)
    rest = re.sub(rb'<origin xyz="[^"]*" rpy="0 0 1">', b'<origin rpy="0 0 1">', rest)
    assert rest == content.replace(b"<axis xyz='0 1.0 0'/>", b"<axis xyz='0 -1 0'/>")


def test_numbers_that_do_not_change_stay_as_they_are_written(tmp_path: Path) -> None:
    path = write(tmp_path, ODD.replace("xyz = '0.2  1e-1\n0'", "xyz='2e-1 1.00e-1 0.0'").replace("ISO-8859-1", "utf-8"))
    arm, _ = arm_from_chain(read_chain(path))
    x = arm.parameters
    x[arm.parameter_names.index("probe.ball.z")] += 1.0
    filled = check(path, arm.with_parameters(x), "tool")
    assert [change.joint for change in filled.changes] == ["t"]
    assert b"xyz='2e-1 1.00e-1 0.0'" in filled.content
    assert b'<origin xyz="' in filled.content


def test_angles_are_told_as_they_were_before(tmp_path: Path) -> None:
    told = (3.0, 3.1, -3.05)  # nearly nothing, the long way round
    made = [Made((0.0, 0.0, 0.1), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), Made((0.2, 0.0, 0.1), told, (0.0, 1.0, 0.0))]
    path = write(tmp_path, urdf([*made, Made((0.2, 0.0, 0.1), (0.1, 7.0, 0.3), (1.0, 0.0, 0.0))]))
    arm, _ = arm_from_chain(read_chain(path))
    check(path, moved(arm), "tip")
    for joint, rpy in zip(
        drawn_joints(path.with_name("filled.urdf"), "tip")[1:3], (told, (0.1, 7.0, 0.3)), strict=True
    ):
        now = [float(part) for part in joint.find("origin").get("rpy").split()]
        assert now == pytest.approx(rpy, abs=0.05)
        assert now != list(rpy)


def test_other_links_stay_where_they_were_on_their_bodies(tmp_path: Path) -> None:
    made = [Made((0.0, 0.0, 0.3), (0.0, 0.0, 0.2), (0.0, 0.0, 1.0))]
    made += [Made((0.2, 0.0, 0.1), (0.1 * k, 1.0, 0.0), (0.0, 1.0, 0.0)) for k in range(4)]
    camera = (
        '<joint name="c" type="fixed"><parent link="l2"/><child link="camera"/><origin xyz="0 0.1 0"/></joint></robot>'
    )
    path = write(tmp_path, urdf(made).replace("</robot>", camera))
    arm, _ = arm_from_chain(read_chain(path, "tip"))
    check(path, moved(arm), "tip")
    q_rad = poses(arm.n, 10)
    before, after = (drawn_frames(each, "camera", q_rad[:, :3]) for each in (path, path.with_name("filled.urdf")))
    assert 0.1 < np.linalg.norm(after[:, :3, 3] - before[:, :3, 3], axis=1).max() < 15
    assert np.abs(after[:, :3, :3] - before[:, :3, :3]).max() < 0.05


def test_an_arm_told_as_denavit_hartenberg_where_the_drawing_is_parallel(tmp_path: Path) -> None:
    # A UR's middle axes: the drawing gives Hayati joints, the arm may have DH joints with offsets of its own choice.
    aside = (0.0, 1.0, 0.0)
    made = [Made((0.0, 0.0, 0.1), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), Made((0.0, 0.1, 0.0), (0.0, 0.0, 0.0), aside)]
    made += [Made((0.6, -0.1, 0.0), (0.0, 0.0, 0.0), aside), Made((0.5, 0.1, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 1.0))]
    path = write(tmp_path, urdf(made))
    arm, _ = arm_from_chain(read_chain(path))
    assert arm.joints[1].model == "hayati"
    own = link_between(*_line(arm.joints[1]), like=replace(arm.joints[1], model="dh"))
    assert own.model == "hayati"  # exactly parallel: there is no common normal to choose
    tilted = replace(arm.joints[1], alpha_rad=1e-3)
    own = link_between(*_line(tilted), like=replace(tilted, model="dh"))
    assert own.model == "dh"
    rest = np.linalg.inv(link_at_zero(own)) @ link_at_zero(tilted)
    third = replace(
        arm.joints[2],
        theta0_rad=arm.joints[2].theta0_rad - math.atan2(rest[1, 0], rest[0, 0]),
        d_mm=arm.joints[2].d_mm + rest[2, 3],
    )
    as_dh = replace(arm, joints=(arm.joints[0], own, third, *arm.joints[3:]))
    as_hayati = replace(arm, joints=(arm.joints[0], tilted, *arm.joints[2:]))
    q_rad = poses(4)
    assert np.abs(as_dh.tip(q_rad) - as_hayati.tip(q_rad)).max() < 1e-9
    changes = [check(path, each, "tip").changes for each in (as_dh, as_hayati)]
    for one, other in zip(*changes, strict=True):
        assert one.joint == other.joint
        assert (one.shift_mm, one.turn_rad) == pytest.approx((other.shift_mm, other.turn_rad), abs=1e-6)
        assert one.shift_mm < 1


def _line(joint):
    t = link_at_zero(joint)
    return t[:3, 3], t[:3, 2]


def test_axes_in_one_line_do_not_spin_their_links(tmp_path: Path) -> None:
    up = (0.0, 0.0, 1.0)
    made = [Made((0.0, 0.0, 0.1), (0.0, 0.0, 0.3 * k), up if k % 2 else (0.0, 0.0, -1.0)) for k in range(3)]
    made += [Made((0.2, 0.0, 0.0), (0.0, 1.0, 0.3), up), Made((0.2, 0.0, 0.0), (0.0, 1.0, 0.3), up)]
    path = write(tmp_path, urdf(made))
    arm, _ = arm_from_chain(read_chain(path))
    for seed in range(5):
        filled = check(path, moved(arm, seed=seed), "tip")
        assert max(change.turn_rad for change in filled.changes) < 0.05


def test_what_is_said_of_the_changes(tmp_path: Path) -> None:
    path = write(tmp_path, urdf([Made((0, 0, 0.1), (0, 0, 0), (0, 0, 1)), Made((0.2, 0, 0), (0, 0, 0), (0, 1, 0))]))
    arm, _ = arm_from_chain(read_chain(path))
    as_drawn = check(path, arm, "tip")
    says(summary(as_drawn, "ball"), "no origin changed", "'tip'", "'ball'", "as drawn")
    filled = check(path, moved(arm), "tip")
    says(summary(filled, "ball"), "3 origins changed", "mm (joint '", "rad (joint '", "link 'tip' ends in probe 'ball'")
    assert remarks(filled) == []
    joints = (arm.joints[0], replace(arm.joints[1], sign=-1))
    probe = arm.probes["ball"]
    far = replace(arm, joints=joints, probes={"ball": replace(probe, x_mm=probe.x_mm + 51)})
    reversed_axis, far_off = remarks(check(path, far, "tip"))
    says(reversed_axis, "the axis of joint 'j1' was turned round", "sign", "limits", "check them")
    says(far_off, "more than 50 mm or 0.2 rad", "those of j2", "arm's own URDF", "link 'root'")


Spoil = Callable[[str], str]
BAD: dict[str, tuple[Spoil, str | None, tuple[str, ...]]] = {
    "another robot": (
        lambda text: text.replace('name="j1" type="continuous"', 'name="j1" type="fixed"'),
        None,
        ("there are 2 rotary joints up to link 'tip', arm 'made' has 3", "the arm's own URDF", "--tip-link"),
    ),
    "a tip that turns": (
        lambda text: text,
        "l2",
        ("link 'l2' turns with joint 'j2'", "a link behind a fixed joint", "--tip-link"),
    ),
    "no such tip": (lambda text: text, "top", ("no link 'top' below a joint", "Did you mean 'tip'?")),
    "no URDF": (lambda text: text.replace("robot", "sdf"), None, ("outermost element is <sdf>",)),
}


@pytest.mark.parametrize("case", BAD)
def test_a_template_that_does_not_fit(tmp_path: Path, case: str) -> None:
    spoil, tip_link, fragments = BAD[case]
    text = urdf([Made((0.1, 0.0, 0.2), (0.4 * k, 0.0, 0.0), (0.0, 0.0, 1.0)) for k in range(3)])
    path = write(tmp_path, text)
    arm, _ = arm_from_chain(read_chain(path))
    write(tmp_path, spoil(text))
    with pytest.raises(UlnaInputError) as caught:
        export_template(path, arm, "ball", tip_link)
    says(str(caught.value), f"{path}: ", *fragments)


def test_a_probe_other_than_the_drawn_tip(tmp_path: Path) -> None:
    path = write(tmp_path, urdf([Made((0.1, 0.0, 0.2), (0.4 * k, 0.0, 0.0), (0.0, 0.0, 1.0)) for k in range(3)]))
    arm, _ = arm_from_chain(read_chain(path))
    two = replace(arm, probes=arm.probes | {"bent": Probe(40.0, -3.0, 210.0)})
    filled = check(path, two, "tip", probe="bent")
    assert [change.joint for change in filled.changes] == ["j3"]
    assert ElementTree.fromstring(filled.content).get("name") == "made"
