"""An arm written as a URDF has the same tips for the same encoder angles, and is the same arm when read again."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from tests.oracle import arms
from tests.oracle.chain import Chain
from tests.oracle.drawn import drawn_joints, drawn_tips
from tests.small_study import says
from tests.urdf_texts import Made, chains, chains_that_slide, poses, urdf, write

from ulna import Arm, Joint, Probe, UlnaInputError
from ulna.exchange.export.source import not_carried, read_source, remark_not_carried
from ulna.exchange.export.urdf import urdf_text
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"


def _arm(chain: Chain) -> Arm:
    """The oracle's arm as the program's."""
    rows = zip(chain.theta0_rad, chain.alpha_rad, chain.a_mm, chain.last, chain.hayati, chain.sign, strict=False)
    joints = [
        Joint(t, alpha, a, 0.0 if h else last, last if h else 0.0, sign, "hayati" if h else "dh")
        for t, alpha, a, last, h, sign in rows
    ]
    probes = {f"p{k}": Probe(*tip) for k, tip in enumerate(np.asarray(chain.tips_mm).tolist())}
    return Arm("oracle", (*joints, Joint(sign=chain.sign[-1])), probes)


@pytest.mark.parametrize("name", arms.ALL)
def test_the_written_chain_is_the_arm(tmp_path: Path, name: str) -> None:
    chain = arms.ALL[name]()
    arm = _arm(chain)
    path = write(tmp_path, urdf_text(arm))
    q_rad = poses(arm.n)
    for index, probe in enumerate(arm.probes):
        assert np.abs(drawn_tips(path, probe, q_rad) - chain.tip(q_rad, index)).max() < 1e-9
        again, t_root_base = arm_from_chain(read_chain(path, probe))
        assert np.abs(again.tip(q_rad) - arm.tip(q_rad, probe)).max() < 1e-9
        assert np.array_equal(t_root_base, np.eye(4))


def rounding_mm(arm: Arm) -> float:
    """What rounding may leave: of arms that reach ten kilometres more than of others."""
    return 1e-9 + 16.0 * np.finfo(np.float64).eps * float(arm.core.reach_mm(0))


@given(chains)
def test_import_export_import(tmp_path_factory: pytest.TempPathFactory, made: list[Made]) -> None:
    folder = tmp_path_factory.mktemp("urdf")
    arm, _ = arm_from_chain(read_chain(write(folder, urdf(made))))
    again, t_root_base = arm_from_chain(read_chain(write(folder, urdf_text(arm), "again.urdf")))
    q_rad = poses(arm.n, 5)
    assert np.abs(again.tip(q_rad) - arm.tip(q_rad)).max() < rounding_mm(arm)
    assert np.array_equal(t_root_base, np.eye(4))
    assert [joint.model for joint in again.joints] == [joint.model for joint in arm.joints]


@given(chains_that_slide)
def test_slides_come_back_too(tmp_path_factory: pytest.TempPathFactory, made: list[Made]) -> None:
    folder = tmp_path_factory.mktemp("urdf")
    arm, _ = arm_from_chain(read_chain(write(folder, urdf(made)), "tip"))
    path = write(folder, urdf_text(arm), "again.urdf")
    again, _ = arm_from_chain(read_chain(path, "ball"))
    q_rad = np.where(arm.slides, 100.0, 1.0) * poses(arm.n, 5)
    assert np.abs(drawn_tips(path, "ball", q_rad) - arm.tip(q_rad)).max() < rounding_mm(arm)
    assert np.abs(again.tip(q_rad) - arm.tip(q_rad)).max() < rounding_mm(arm)
    for one, other in zip(arm.joints, again.joints, strict=True):
        assert one.type == other.type
        assert one.limits_rad == (other.limits_rad and pytest.approx(other.limits_rad))


def test_what_ros_demands_of_the_file(tmp_path: Path) -> None:
    arm = replace(
        _arm(arms.snake()),
        name='a <strange> "name" & so on',
        joints=(
            Joint(0.1, 0.2, 30.0, 40.0, name="wrist roll", limits_rad=(-1.5, 2.0), sign=-1),
            Joint(0.1, 0.2, 30.0, 40.0, name="wrist roll"),
            Joint(),
        ),
        probes={"link_3": Probe(1.0, 2.0, 3.0), "base_link": Probe(4.0, 5.0, 6.0)},
    )
    path = write(tmp_path, urdf_text(arm))
    robot = ElementTree.parse(path).getroot()
    links = [link.get("name") for link in robot.findall("link")]
    joints = robot.findall("joint")
    assert robot.get("name") == "a__strange___name____so_on"
    assert links == ["base_link", "link_1", "link_2", "link_3", "link_3_2", "base_link_2"]
    assert [joint.get("name") for joint in joints] == [
        "wrist_roll",
        "wrist_roll_2",
        "joint_3",
        "link_3_2_joint",
        "base_link_2_joint",
    ]
    assert [joint.get("type") for joint in joints] == ["revolute", "continuous", "continuous", "fixed", "fixed"]
    assert joints[0].find("axis").get("xyz") == "0 0 -1"
    assert joints[0].find("limit").attrib == {"lower": "-1.5", "upper": "2", "effort": "0", "velocity": "0"}
    assert joints[1].find("limit") is None
    assert len(drawn_joints(path, "base_link_2")) == 4
    for probe, link in (("link_3", "link_3_2"), ("base_link", "base_link_2")):
        assert np.abs(drawn_tips(path, link, poses(3)) - arm.tip(poses(3), probe)).max() < 1e-9


def test_a_drawing_in_metres_becomes_metres_again(tmp_path: Path) -> None:
    text = urdf_text(Arm("plain", (Joint(0.0, 0.0, 200.0, 100.0), Joint()), {"ball": Probe(0.0, 0.0, 300.0)}))
    assert '<origin xyz="0 0 0.1" rpy="0 0 0"/>' in text
    assert '<origin xyz="0.2 0 0" rpy="0 0 0"/>' in text
    assert '<origin xyz="0 0 0.3" rpy="0 0 0"/>' in text


def test_what_is_said_of_the_numbers(tmp_path: Path) -> None:
    source = read_source(FOSSILS / "result-1.json", "a URDF", has_base=True)
    (remark,) = source.remarks
    says(
        remark,
        "result-1.json: the readings did not determine joint.1.d, probe.straight.x, probe.straight.y, probe.straight.z",
        "what they left open of them is as the calibration started",
        "'identifiability'",
    )
    assert read_source(FOSSILS / "arm-1.toml", "a URDF", has_base=True).remarks == []
    document = json.loads((FOSSILS / "result-1.json").read_text())
    document["fit"] |= {"converged": False, "termination": "poor-minimum"}
    (tmp_path / "result.json").write_text(json.dumps(document))
    failed = read_source(tmp_path / "result.json", "a URDF", has_base=True).remarks[0]
    says(failed, "result.json: the fit did not converge (poor-minimum)", "do not use these numbers")
    (tmp_path / "result.json").write_text(json.dumps(document | {"fit": 1, "parameters": [2, {"status": 3}]}))
    with pytest.raises(UlnaInputError, match="key 'parameters'"):
        read_source(tmp_path / "result.json", "a URDF", has_base=True)


def test_what_a_urdf_cannot_carry_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not_carried(_arm(arms.elbow()), has_base=True) == []
    says(
        remark_not_carried(["harmonics of joint 2", "compliance"], "a URDF", Path("arm.toml")),
        "arm.toml: a URDF has no place for harmonics of joint 2, compliance",
        "differ from the arm's",
    )
    monkeypatch.setattr("ulna.exchange.export.source.not_carried", lambda arm, has_base: [f"{arm.n} springs"])
    assert "4 springs" in read_source(FOSSILS / "arm-1.toml", "a URDF", has_base=True).remarks[0]


def test_a_sign_that_is_not_known_cannot_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    unknown = _arm(arms.elbow())
    unknown = replace(unknown, joints=(replace(unknown.joints[0], sign=0), *unknown.joints[1:]))
    monkeypatch.setattr("ulna.exchange.export.source.Arm.load", lambda _: unknown)
    with pytest.raises(UlnaInputError) as caught:
        read_source(Path("arm.toml"), "a URDF", has_base=True)
    says(str(caught.value), "arm.toml: key 'joint.1.sign': got 0", "expected 1 or -1", "Calibrate first")


def test_where_the_first_axis_stands_goes_along(tmp_path: Path) -> None:
    """It leans and stands aside in the base frame: the root link of a URDF."""
    arm = _arm(arms.snake())
    effects = replace(arm.joints[0].effects, base_tilt_rad=(0.02, -0.03), base_offset_mm=(4.0, -7.0))
    leaning = replace(arm, joints=(replace(arm.joints[0], effects=effects), *arm.joints[1:]))
    path = write(tmp_path, urdf_text(leaning))
    q_rad = poses(arm.n)
    for probe in arm.probes:
        assert np.abs(drawn_tips(path, probe, q_rad) - leaning.tip(q_rad, probe)).max() < 1e-9
    assert np.abs(leaning.tip(q_rad, probe) - arm.tip(q_rad, probe)).max() > 1.0
    assert not_carried(leaning, has_base=True) == []
    assert len(not_carried(leaning, has_base=False)) == 2
