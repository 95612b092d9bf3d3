"""What is foreign in a URDF is refused or named, never dropped: words, units, names, what else may have been meant."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.drawn import drawn_tips
from tests.small_study import says
from tests.urdf_texts import Made, poses, tips_in_root, urdf, write

from ulna import UlnaInputError
from ulna.arm.frames.rigid import from_quaternion, from_rpy, to_quaternion
from ulna.exchange.export.template import export_template
from ulna.exchange.importers.urdf import import_urdf
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import Chain, read_chain
from ulna.exchange.urdf.units import in_units

STRAIGHT, UP = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
MADE = [
    Made((0.0, 0.0, 0.3), STRAIGHT, UP),
    Made((0.2, 0.0, 0.1), (0.4, 1.0, -0.3), UP),
    Made((0.3, 0.1, 0.0), (1.2, 0.2, 0.1), UP),
]
TEXT = urdf(MADE)
LIMITED = TEXT.replace('"continuous"', '"revolute"').replace("<axis", '<limit lower="-2" upper="2.5"/><axis')


def chain(folder: Path, text: str, tip: str | None = None, base: str | None = None) -> Chain:
    return read_chain(write(folder, text), tip, base)


def error(folder: Path, text: str) -> str:
    with pytest.raises(UlnaInputError) as caught:
        import_urdf(write(folder, text), folder / "arm.toml")
    assert not (folder / "arm.toml").exists()
    return str(caught.value)


SPOILT: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "a misspelt attribute": ("rpy=", "ryp=", ("joint 'j0', origin", "unknown attribute ryp=", "Did you mean 'rpy'?")),
    "capitals": (
        "<origin xyz='",
        "<Origin xyz='",
        ("joint 'j0'", "unknown element <Origin>", "Did you mean 'origin'?"),
    ),
    "a misspelt element": ("<axis", "<axes", ("joint 'j0'", "<axes>", "Did you mean 'axis'?")),
    "a joint in capitals": ("</robot>", "<Joint/></robot>", ("unknown element <Joint>", "Did you mean 'joint'?")),
    "two origins": ("<axis", '<origin xyz="1 0 0"/><axis', ("joint 'j0'", "2 elements <origin>", "expected one")),
    "two joints of one name": ('name="j1"', 'name="j0"', ("2 joints are called 'j0'", "Rename one")),
    "two links of one name": ('<link name="root"/>', '<link name="root"/><link name="root"/>', ("2 links", "'root'")),
    "a link that is not there": ('parent link="l0"', 'parent link="L0"', ("joint 'j1'", "parent link 'L0'", "'l0'?")),
    "rotations in degrees": ("rpy=", 'rpy="0 90 0" old:rpy=', ("joint 'j0', rpy", "'0 90 0'", "in rad")),
    "two ways of turning": (
        "rpy=",
        'quat_xyzw="0 0 0 1" rpy=',
        ("joint 'j0', origin", "rpy", "quat_xyzw", "one of them"),
    ),
    "no unit quaternion": ("rpy=", 'quat_xyzw="0 0 1 1" old:rpy=', ("quat_xyzw: got '0 0 1 1'", "length is 1.41421")),
    "half a quaternion": ("rpy=", 'quat_xyzw="0 0 1" old:rpy=', ("quat_xyzw: got '0 0 1'", "four numbers")),
}


@pytest.mark.parametrize("case", SPOILT)
def test_what_looks_like_something_known_is_refused(tmp_path: Path, case: str) -> None:
    old, new, fragments = SPOILT[case]
    text = TEXT.replace('<robot name="made">', '<robot name="made" xmlns:old="x">').replace(old, new, 1)
    says(error(tmp_path, text), "made.urdf: ", *fragments)


def test_what_stands_beside_is_named(tmp_path: Path) -> None:
    text = TEXT.replace("</robot>", '<link name="alone"/><ros2_control/><gazebo/></robot>')
    text = text.replace("<axis", '<hardware/><axis shown="yes"', 1)
    said = " ".join(chain(tmp_path, text).remarks)
    says(said, "<ros2_control>", "'alone'", "joint 'j0'", "<hardware>", "attribute shown of <axis>")
    assert "gazebo" not in said
    assert chain(tmp_path, TEXT).remarks == ()


unit = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


@given(unit)
@settings(max_examples=200, deadline=None)
def test_a_quaternion_and_back(q: tuple[float, float, float, float]) -> None:
    given_, found = np.array(q) / np.linalg.norm(q), from_quaternion(np.array(q) / np.linalg.norm(q))
    # q v q*, written out by Hamilton's product
    x, y, z, w = given_
    hamilton = np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )
    np.testing.assert_allclose(found, hamilton, atol=1e-14)
    np.testing.assert_allclose(from_quaternion(to_quaternion(found)), found, atol=1e-14)


def by_quaternions(text: str) -> str:
    """The same drawing in URDF 1.1."""
    for joint in [*MADE, Made((0.03, -0.02, 0.1), (0.0, 0.3, 0.0), None)]:
        rpy = " ".join(repr(float(angle)) for angle in joint.rpy)
        quaternion = " ".join(repr(float(value)) for value in to_quaternion(from_rpy(*joint.rpy)))
        text = text.replace(f'rpy="{rpy}"', f'quat_xyzw="{quaternion}"', 1)
    assert "rpy=" not in text
    return text


def test_a_robot_drawn_with_quaternions_is_the_robot_drawn_with_angles(tmp_path: Path) -> None:
    write(tmp_path, TEXT)
    expected = drawn_tips(tmp_path / "made.urdf", "tip", poses(3, 20))
    turned, t_turned = arm_from_chain(chain(tmp_path, by_quaternions(TEXT)))
    np.testing.assert_allclose(tips_in_root(turned, t_turned, poses(3, 20)), expected, atol=1e-9)
    # and put back into it, as it is and calibrated
    path = tmp_path / "made.urdf"
    assert export_template(path, turned, "ball").content == path.read_bytes()
    moved = turned.with_parameters(turned.parameters + 1e-3)
    path.write_bytes(export_template(path, moved, "ball").content)
    assert b"rpy" not in path.read_bytes()
    again, t_again = arm_from_chain(read_chain(path))
    np.testing.assert_allclose(
        tips_in_root(again, t_again, poses(3, 20)), tips_in_root(moved, t_turned, poses(3, 20)), atol=1e-9
    )


def test_units_that_cannot_be_are_asked_about_and_stated_ones_hold(tmp_path: Path) -> None:
    degrees = LIMITED.replace('lower="-2" upper="2.5"', 'lower="-90" upper="120"')
    says(error(tmp_path, degrees), "joint 'j0', limit", "-90 to 120 rad", "--angle-unit deg")
    for angle_unit, factor in (("deg", np.pi / 180.0), ("rad", 1.0)):
        found = in_units(chain(tmp_path, degrees), angle_unit=angle_unit)
        assert found.turning[0].limits_rad == pytest.approx((-90 * factor, 120 * factor))
    millimetres = urdf([Made(tuple(1000.0 * x for x in made.xyz_m), made.rpy, made.axis) for made in MADE])  # type: ignore[arg-type]
    says(error(tmp_path, millimetres), "m long in all", "--length-unit mm")
    # the tip of `urdf` stays in m
    expected = arm_from_chain(chain(tmp_path, TEXT, "l2"))[0]
    found_arm = arm_from_chain(in_units(chain(tmp_path, millimetres, "l2"), "mm"))[0]
    np.testing.assert_allclose(found_arm.tip(poses(3, 20)), expected.tip(poses(3, 20)), atol=1e-9)
    with pytest.raises(UlnaInputError, match="--length-unit"):
        export_template(write(tmp_path, millimetres), expected, "ball")


def branch(names: str, parent: str, kind: str = "revolute") -> str:
    out = ""
    for name in names:
        out += f'<link name="{name}"/><joint name="to_{name}" type="{kind}"><parent link="{parent}"/>'
        out += f'<child link="{name}"/><origin xyz="0.1 0 0"/><axis xyz="0 1 0"/></joint>'
        parent = name
    return out


def test_what_else_may_have_been_meant_is_asked_about_or_named(tmp_path: Path) -> None:
    def with_(more: str) -> str:
        return TEXT.replace("</robot>", more + "</robot>")

    # as good: asked
    assert "--tip-link" in error(tmp_path, with_(branch("abc", "root")))
    two_trees = with_('<link name="other"/>' + branch("abc", "other"))
    says(error(tmp_path, two_trees), "'root', 'other'", "--base-link")
    assert chain(tmp_path, two_trees, base="other").tip_link == "c"
    # less good: named
    (said,) = chain(tmp_path, with_(branch("ab", "root"))).remarks
    says(said, "the tip is link 'tip'", "other chains end at 'b'", "--tip-link")
    (said,) = chain(tmp_path, with_(branch("t", "l2", "fixed"))).remarks
    says(said, "the tip is link 'tip'", "the last joint also carries 't'", "--tip-link")
    # stated: neither
    assert chain(tmp_path, with_(branch("t", "l2", "fixed")), "t").remarks == ()
