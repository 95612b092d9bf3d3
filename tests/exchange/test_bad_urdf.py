"""Every way in which a robot's description can be wrong, and what the user is told: file, element, value, remedy."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from tests.small_study import says

from ulna import Arm, UlnaInputError
from ulna.exchange.importers.urdf import import_urdf
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain

URDF = """<?xml version="1.0"?>
<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="ball_link"/>
  <joint name="j1" type="revolute">
    <parent link="base"/><child link="l1"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="2.5" effort="1" velocity="1"/>
  </joint>
  <joint name="j2" type="continuous">
    <parent link="l1"/><child link="l2"/><origin xyz="0.2 0 0"/><axis xyz="0 2 0"/>
  </joint>
  <joint name="t" type="fixed"><parent link="l2"/><child link="ball_link"/><origin xyz="0 0 0.3"/></joint>
</robot>
"""


def _arm(tmp_path: Path, text: str = URDF, tip_link: str | None = None) -> Arm:
    path = tmp_path / "two.urdf"
    path.write_text(text, encoding="utf-8")
    return arm_from_chain(read_chain(path, tip_link))[0]


def test_the_good_one_is_good(tmp_path: Path) -> None:
    arm = _arm(tmp_path)
    assert (arm.name, arm.n, arm.joints[0].limits_rad) == ("two", 2, (-3.0, 2.5))
    assert arm.tip([0.0, 0.0]) == pytest.approx([200, 0, 400], abs=1e-9)
    assert arm.tip([1.5707963267948966, 1.5707963267948966]) == pytest.approx([0, 500, 100], abs=1e-9)


EXTRA = '<joint name="x" type="fixed"><parent link="l2"/><child link="l1"/></joint></robot>'
CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "no XML": ("<robot", "<robot <", ("not valid XML", "line 2", "Correct that place")),
    "half a file": ("</robot>", "", ("not valid XML", "no element found")),
    "an encoding that nobody knows": ('version="1.0"', 'version="1.0" encoding="klingon"', ("not valid XML",)),
    "another program's": ("robot", "sdf", ("outermost element is <sdf>", "expected <robot>", "Name the right file")),
    "xacro": (
        '<link name="base"/>',
        '<xacro:include filename="x"/>',
        ("element <xacro:include>", "a URDF is yet to be made", "xacro FILE > robot.urdf"),
    ),
    "xacro by another prefix": (
        'xmlns:xacro="http://www.ros.org/wiki/xacro">',
        'xmlns:x="http://wiki.ros.org/xacro"><x:macro name="a"/>',
        ("element <x:macro>", "xacro file"),
    ),
    "a number for xacro": ('"0 0 0.1"', '"0 0 ${h}"', ("joint 'j1', xyz", "'0 0 ${h}'", "This is xacro")),
    "no child": ('<child link="l1"/>', "", ("joint 'j1' names no child link", '<child link="…"/>', "Add it")),
    "no parent": ('<parent link="l1"/>', "", ("joint 'j2' names no parent link", "Add it")),
    "no name": ('name="j2"', 'nome="j2"', ("the joint above link 'l2' has no name", "Add it")),
    "sliding without an end": ("continuous", "prismatic", ("joint 'j2' is prismatic", "no limits", "<limit")),
    "floating": (
        "continuous",
        "floating",
        ("joint 'j2' is of type 'floating'", "fixed joints from base to tip", "--base-link"),
    ),
    "no type": ('type="continuous"', "", ("joint 'j2' is of type 'None'",)),
    "mimicking": (
        '<axis xyz="0 2 0"/>',
        '<axis xyz="0 2 0"/><mimic joint="j1"/>',
        ("joint 'j2' mimics joint 'j1'", "encoders of their own", "--tip-link"),
    ),
    "one joint": ("continuous", "fixed", ("there are 1 joints that turn or slide up to link", "at least two")),
    "no joints": (URDF[URDF.index("  <joint") :], "</robot>", ("there are no joints", "at least two")),
    "two numbers": ('"0.2 0 0"', '"0.2 0"', ("joint 'j2', xyz", "'0.2 0'", "three numbers", "Correct it")),
    "no number": ('"0.2 0 0"', '"0.2 0 o"', ("joint 'j2', xyz", "'0.2 0 o'", "three numbers")),
    "infinite": ('"0.2 0 0"', '"0.2 0 inf"', ("'0.2 0 inf'", "three numbers")),
    "not a number": ('"0.2 0 0"', '"0.2 0 nan"', ("'0.2 0 nan'", "three numbers")),
    "absurd": ('"0.2 0 0"', '"0.2 0 1e300"', ("'0.2 0 1e300'", "three numbers")),
    "no direction": ('"0 2 0"', '"0 0 0"', ("joint 'j2', axis", "'0 0 0'", "has no direction", "'0 0 1'")),
    "a limit in words": ('"2.5"', '"far"', ("joint 'j1', limit upper", "'far'", "a number")),
    "limits swapped": ('"2.5"', '"-4"', ("joint 'j1', limit", "lower '-3' and upper '-4'", "Swap them")),
    "two parents": ("</robot>", EXTRA, ("link 'l1' is the child of two joints, 'j1' and 'x'", "expected one")),
    "a circle": ('<parent link="base"/>', '<parent link="l2"/>', ("'j1', 'j2'", "go round in a circle", "parents")),
    "a document type": (
        "<robot",
        '<!DOCTYPE robot [<!ENTITY a "b">]><robot',
        ("line 2", "a document type", "may define entities", "Remove it"),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_what_a_description_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = CASES[case]
    assert old in URDF
    with pytest.raises(UlnaInputError) as caught:
        _arm(tmp_path, URDF.replace(old, new) if case == "another program's" else URDF.replace(old, new, 1))
    says(str(caught.value), f"{tmp_path / 'two.urdf'}: ", *fragments)


def test_an_unknown_link(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError) as caught:
        _arm(tmp_path, tip_link="bal_link")
    says(str(caught.value), "there is no link 'bal_link' below a joint", "Did you mean 'ball_link'?")


@pytest.mark.parametrize(
    ("content", "fragments"),
    [
        (b" \n", ("the file is empty", "a robot description")),
        (URDF.encode("utf-16"), ("UTF-16", "Save it as UTF-8")),
        (b"<robot>" + b" " * (16 << 20), ("more than 8 MB", "Check the path")),
    ],
)
def test_a_file_that_cannot_be_one(tmp_path: Path, content: bytes, fragments: tuple[str, ...]) -> None:
    (tmp_path / "x.urdf").write_bytes(content)
    with pytest.raises(UlnaInputError) as caught:
        read_chain(tmp_path / "x.urdf")
    says(str(caught.value), f"{tmp_path / 'x.urdf'}: ", *fragments)


def test_bombs_and_files_of_the_reader_are_left_alone(tmp_path: Path) -> None:
    lol = '<!ENTITY l0 "lol">' + "".join(f'<!ENTITY l{k + 1} "{f"&l{k};" * 10}">' for k in range(12))
    outside = f'<!ENTITY f SYSTEM "{(tmp_path / "secret").as_uri()}">'
    (tmp_path / "secret").write_text("two")
    for declared, used in ((lol, "&l12;"), (outside, "&f;")):
        began = time.monotonic()
        with pytest.raises(UlnaInputError, match="document type"):
            _arm(tmp_path, URDF.replace("<robot", f"<!DOCTYPE robot [{declared}]><robot").replace("two", used))
        assert time.monotonic() - began < 1
    with pytest.raises(UlnaInputError, match="undefined entity"):
        _arm(tmp_path, URDF.replace("two", "&l12;"))
    deep = "<a>" * 300_000 + "</a>" * 300_000
    assert _arm(tmp_path, URDF.replace("</robot>", deep + "</robot>")).n == 2


@pytest.mark.parametrize(
    ("old", "new", "limits"),
    [
        ('lower="-3" ', "", (0.0, 2.5)),  # URDF: a limit that is not there is 0
        ('lower="-3" upper="2.5"', "", None),
        ('lower="-3" upper="2.5"', 'lower="0" upper="0"', None),
        ('lower="-3" upper="2.5"', 'lower="-1e16" upper="inf"', None),
        ('type="revolute"', 'type="continuous"', None),
    ],
)
def test_limits(tmp_path: Path, old: str, new: str, limits: tuple[float, float] | None) -> None:
    assert _arm(tmp_path, URDF.replace(old, new)).joints[0].limits_rad == limits


def _branch(name: str, parent: str, kind: str, more: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{name}_link"/>'
        f'<origin xyz="0.01 0 0"/><axis xyz="0 0 1"/>{more}</joint><link name="{name}_link"/>'
    )


def test_a_base_in_the_middle(tmp_path: Path) -> None:
    lift = _branch("lift", "world", "floating").replace('<link name="lift_link"/>', '<link name="world"/>')
    lift = lift.replace("lift_link", "base")
    beside = (
        _branch("b1", "world", "revolute") + _branch("b2", "b1_link", "revolute") + _branch("b3", "b2_link", "fixed")
    )
    path = tmp_path / "two.urdf"
    path.write_text(URDF.replace("</robot>", f"{lift}{beside}</robot>"))
    assert read_chain(path).tip_link == "b3_link"
    with pytest.raises(UlnaInputError, match=r"joint 'lift' is of type 'floating'.*--base-link"):
        read_chain(path, "ball_link")
    for tip_link in ("ball_link", None):
        chain = read_chain(path, tip_link, "base")
        assert (chain.base_link, chain.tip_link, len(chain.steps)) == ("base", "ball_link", 3)
        assert arm_from_chain(chain)[0].tip([0.0, 0.0]) == pytest.approx([200, 0, 400], abs=1e-9)
    with pytest.raises(UlnaInputError) as caught:
        read_chain(path, None, "bass")
    says(str(caught.value), f"{path}: there is no link 'bass' above a joint", "Did you mean 'base'?")
    with pytest.raises(UlnaInputError, match="no link 'b3_link' below a joint"):
        read_chain(path, "b3_link", "base")


def test_which_link_is_the_tip(tmp_path: Path) -> None:
    def tip(*branches: str, ball: bool = True) -> str:
        text = URDF if ball else URDF.replace("ball_link", "tool")
        path = tmp_path / "two.urdf"
        path.write_text(text.replace("</robot>", "".join(branches) + "</robot>"))
        return read_chain(path).tip_link

    assert tip() == "ball_link"
    assert tip(_branch("far", "ball_link", "fixed")) == "ball_link"  # the usual name wins over the outermost
    assert tip(ball=False) == "tool"
    assert tip(_branch("far", "tool", "fixed"), ball=False) == "far_link"
    # fingers that slide or mimic are no arms; one that turns by itself is
    slide = _branch("slide", "tool", "prismatic", '<limit lower="0" upper="0.1"/>')
    assert tip(slide, _branch("end", "slide_link", "fixed"), ball=False) == "tool"
    assert tip(slide, _branch("end", "slide_link", "revolute"), ball=False) == "end_link"
    assert tip(_branch("copy", "tool", "revolute", '<mimic joint="j1"/>'), ball=False) == "tool"
    assert tip(_branch("more", "ball_link", "revolute")) == "more_link"
    with pytest.raises(UlnaInputError) as caught:
        tip(_branch("left", "tool", "revolute"), _branch("right", "tool", "revolute"), ball=False)
    says(str(caught.value), "several chains have 3 rotary joints", "'left_link', 'right_link'", "--tip-link")


def test_nothing_is_written_over_the_description(tmp_path: Path) -> None:
    path = tmp_path / "two.urdf"
    path.write_text(URDF)
    with pytest.raises(UlnaInputError, match="is an input of this run"):
        import_urdf(path, path, force=True)
    with pytest.raises(UlnaInputError, match="no such file; expected a robot description"):
        import_urdf(tmp_path / "three.urdf", tmp_path / "arm.toml")
    assert path.read_text() == URDF
