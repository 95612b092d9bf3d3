"""Tables of Denavit–Hartenberg parameters: written, read, and what a table that cannot be read is told."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.exchange.test_export_urdf import _arm as of_oracle
from tests.oracle import arms
from tests.oracle.craig import PANDA, PANDA_FLANGE_MM, craig_tips
from tests.oracle.drawn import drawn_tips
from tests.small_study import says
from tests.urdf_texts import poses

from ulna import Arm, Joint, Probe, UlnaInputError
from ulna.arm.frames.links import link_at_zero, moved
from ulna.exchange.export.dh import dh_table
from ulna.exchange.export.urdf import urdf_text
from ulna.exchange.importers.dh import import_dh
from ulna.exchange.importers.robots import panda, ur10

CONVENTIONS = ("dh", "modified-dh")
FREE_OF_BETA = [name for name in arms.ALL if name not in ("parallel axes", "nine joints")]


def _written(folder: Path, arm: Arm, convention: str, length: str = "mm", angle: str = "rad") -> Path:
    path = folder / "table.csv"
    path.write_text(dh_table(arm, convention, Path("arm.toml"), length, angle), encoding="utf-8")
    return path


def _read(path: Path, convention: str, *options: object) -> Arm:
    return import_dh(path, path.with_suffix(".toml"), convention, *options, force=True).arm


@pytest.mark.parametrize(
    ("name", "convention"),
    [(name, "dh") for name in arms.ALL] + [(name, "modified-dh") for name in FREE_OF_BETA],
)
@pytest.mark.parametrize(("length", "angle"), [("mm", "rad"), ("in", "deg")])
def test_what_is_written_is_read_as_the_same_arm(
    tmp_path: Path, name: str, convention: str, length: str, angle: str
) -> None:
    arm = of_oracle(arms.ALL[name]())
    again = _read(_written(tmp_path, arm, convention, length, angle), convention)
    assert list(again.probes) == list(arm.probes)
    assert again == Arm.load(tmp_path / "table.toml")
    for probe in arm.probes:
        assert np.abs(again.tip(poses(arm.n), probe) - arm.tip(poses(arm.n), probe)).max() < 1e-9


number, turn = st.floats(-500, 500), st.floats(-3, 3)
twist = turn | st.sampled_from([0.0, math.pi, 1e-9, 0.04])


@given(
    st.lists(st.tuples(turn, twist, number, number), min_size=1, max_size=6),
    st.tuples(number | st.just(0.0), number | st.just(0.0), number | st.just(0.0)),
    st.sampled_from(CONVENTIONS),
)
def test_any_arm(
    tmp_path_factory: pytest.TempPathFactory,
    links: list[tuple[float, float, float, float]],
    tip: tuple[float, float, float],
    convention: str,
) -> None:
    arm = Arm("any", (*(Joint(*link) for link in links), Joint(sign=-1)), {"p": Probe(*tip)})
    again = _read(_written(tmp_path_factory.mktemp("dh"), arm, convention), convention)
    assert np.abs(again.tip(poses(arm.n, 5)) - arm.tip(poses(arm.n, 5))).max() < 1e-9
    for joint in again.joints[:-1]:
        assert (joint.model == "hayati") == (abs(math.sin(joint.alpha_rad)) < 0.05)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_a_last_joint_with_a_link_of_its_own(tmp_path: Path, convention: str) -> None:
    # as redundant models of the literature have it: the probe stands at the end of that link
    first, last = Joint(0.3, 1.2, 200.0, 50.0), Joint(0.4, -0.7, 30.0, 20.0, sign=-1)
    full = Arm("full", (first, last), {"p": Probe(10.0, 20.0, 30.0)})
    bare = Arm("bare", (first, Joint(sign=-1)), moved(full.probes, link_at_zero(last)))
    q_rad = poses(2)
    again = _read(_written(tmp_path, full, convention), convention)
    assert np.abs(again.tip(q_rad) - bare.tip(q_rad)).max() < 1e-9
    path = tmp_path / "full.urdf"
    path.write_text(urdf_text(full))
    assert np.abs(drawn_tips(path, "p", q_rad) - bare.tip(q_rad)).max() < 1e-9


def _cells(path: Path) -> list[list[str]]:
    return list(csv.reader(path.read_text(encoding="utf-8").splitlines()))


def test_how_a_table_looks(tmp_path: Path) -> None:
    probes = {"bent": Probe.from_cylindrical(0.5, 40.0, 200.0), "straight": Probe(0.0, 0.0, 250.0)}
    joints = (Joint(0.1, -1.5, 40.0, 250.0, name="waist"), Joint(0.2, 1.5, -30.0, 1.5, sign=-1), Joint())
    table = _cells(_written(tmp_path, Arm("look", joints, probes), "dh"))
    assert table[0] == ["joint", "name", "sign", "theta0_rad", "alpha_rad", "a_mm", "d_mm"]
    assert table[1] == ["1", "waist", "1", "0.1", "-1.5", "40.0", "250.0"]
    assert table[3] == ["3", "joint 3", "1", "0.0", "0.0", "0.0", "0.0"]
    assert table[4][:3] == ["tip", "bent", "1"]
    assert [float(cell) for cell in table[4][3:]] == pytest.approx([0.5, 0.0, 40.0, 200.0])
    assert table[5] == ["tip", "straight", "1", "0.0", "0.0", "0.0", "250.0"]
    table = _cells(_written(tmp_path, Arm("look", joints, probes), "modified-dh", "m", "deg"))
    assert table[0] == ["joint", "name", "sign", "theta0_deg", "alpha_deg", "a_m", "d_m"]
    assert [float(cell) for cell in table[2][3:]] == pytest.approx(
        [math.degrees(0.2), math.degrees(-1.5), 0.04, 0.0015]
    )
    assert [float(cell) for cell in table[3][3:]] == pytest.approx([0.0, math.degrees(1.5), -0.03, 0.0])
    hayati = replace(ur10(), joints=(*ur10().joints[:1], replace(ur10().joints[1], beta_rad=0.001), *ur10().joints[2:]))
    table = _cells(_written(tmp_path, hayati, "dh"))
    assert table[0][-1] == "beta_rad"
    assert [row[-1] for row in table[1:4]] == ["0.0", "0.001", "0.0"]


def test_a_makers_table_in_the_modified_form(tmp_path: Path) -> None:
    rows = zip(PANDA["alpha"], PANDA["a"], PANDA["d"], strict=True)
    lines = [f"J{k},0,{math.degrees(alpha)},{a / 1000},{d / 1000}" for k, (alpha, a, d) in enumerate(rows, start=1)]
    path = tmp_path / "franka.csv"
    flange = f"tip,0,0,0,{PANDA_FLANGE_MM / 1000}"
    path.write_text("\n".join(["joint,theta0,alpha,a,d", *lines, flange]) + "\n")
    arm = _read(path, "modified-dh", "m", "deg")
    expected = craig_tips(PANDA["alpha"], PANDA["a"], [0] * 7, PANDA["d"], [1] * 7, (0, 0, PANDA_FLANGE_MM), poses(7))
    assert np.abs(arm.tip(poses(7)) - expected).max() < 1e-9
    assert [joint.name for joint in arm.joints] == [f"J{k}" for k in range(1, 8)]
    path.write_text("\n".join(["joint,theta0,alpha,a,d", *lines]) + "\n")
    found = import_dh(path, tmp_path / "out.toml", "modified-dh", "m", "deg", tip=(0.0, 0.0, 0.2404))
    assert found.remarks == []
    assert np.abs(found.arm.tip(poses(7)) - panda().tip(poses(7))).max() < 1e-9
    assert list(found.arm.probes) == ["tip"]


def test_a_makers_table_with_parallel_axes(tmp_path: Path) -> None:
    path = tmp_path / "ur10.csv"
    path.write_text(
        "offset_rad,alpha_deg,a_mm,d_m\n0,90,0,0.128\n0,0,-612.7,0\n0,0,-571.6,0\n0,90,0,0.1639\n0,-90,0,0.1157\n"
        "0,0,0,0.0922\n"
    )
    found = import_dh(path, tmp_path / "ur10.toml", "dh")
    assert [joint.model for joint in found.arm.joints] == [joint.model for joint in ur10().joints]
    at_flange = ur10().with_parameters([*ur10().parameters[:-1], 92.2])
    assert np.abs(found.arm.tip(poses(6)) - at_flange.tip(poses(6))).max() < 1e-9
    (remark,) = found.remarks
    says(remark, "Hayati joints", "parallel: 2, 3", "the arm is the same")
    text = (tmp_path / "ur10.toml").read_text()
    assert text.startswith(f"# Made of ur10.csv, convention dh. {found.taken}\n# {remark}\nformat")


def test_an_offset_is_theta0_the_other_way(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("offset,alpha,a,d,sign\n0.25,1.5,10,20,-1\n-0.5,0,0,0,1\n")
    arm = _read(path, "dh", "mm", "rad")
    assert (arm.joints[0].theta0_rad, arm.joints[0].sign) == (-0.25, -1)
    turned = arm.tip([0.0, 0.0])
    path.write_text("theta0,alpha,a,d,sign\n-0.25,1.5,10,20,-1\n0.5,0,0,0,1\n")
    assert _read(path, "dh", "mm", "rad").tip([0.0, 0.0]) == pytest.approx(turned)


def test_a_base_that_the_first_row_moves_is_told(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    rows = [(1.2, 150.0, 0.1, 400.0), (-1.5, 20.0, 0.2, 10.0), (1.4, 300.0, 0.3, 30.0)]
    lines = [",".join(map(repr, row)) for row in rows]
    path.write_text("\n".join(["alpha_rad,a_mm,theta0_rad,d_mm", *lines]) + "\n")
    found = import_dh(path, tmp_path / "arm.toml", "modified-dh")
    (remark,) = found.remarks
    says(remark, "stands on axis 1", "of the table", "xyz = 150, 0, 0 mm", "rpy = 1.2, 0, 0 rad", "in the arm's")
    assert remark in (tmp_path / "arm.toml").read_text()
    alpha, a, theta0, d = zip(*rows, strict=True)
    expected = craig_tips(alpha, a, theta0, d, [1] * 3, (0, 0, 0), poses(3))
    c, s = math.cos(1.2), math.sin(1.2)
    in_table = found.arm.tip(poses(3)) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T + [150, 0, 0]
    assert np.abs(in_table - expected).max() < 1e-9


GOOD = "joint,name,sign,theta0,alpha,a,d\n1,waist,1,0.1,1.5,10,20\n2,elbow,-1,0.2,-1.5,30,40\ntip,ball,1,0,0,5,60\n"
BAD: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "no column of zero offsets": ("theta0,", "", ("there is no column theta0 or offset", "offset = -theta0", "Add it")),
    "both": ("sign,theta0", "offset,theta0", ("both columns theta0 and offset", "one of them", "Remove one")),
    "theta": ("theta0", "theta", ("column 'theta'", "an offset", "zero offset theta0", "Rename it")),
    "no d": ("a,d", "a,beta", ("the column d is missing", "Add it")),
    "an unknown column": ("alpha", "alhpa", ("unknown column 'alhpa'", "Did you mean 'alpha'?", "Remove or rename")),
    "a unit of another kind": ("alpha", "alpha_mm", ("unknown column 'alpha_mm'", "Did you mean 'alpha'?")),
    "twice, in two units": ("joint,name,sign,theta0", "joint,d_mm,sign,theta0", ("column d stands twice", "Remove")),
    "no number": ("30,40", "30,x", ("row 2 (line 3 of the file), column 'd'", "'x'", "a number")),
    "an empty cell": ("30,40", "30,", ("row 2", "column 'd'", "the cell is empty")),
    "degrees": ("-1.5", "-90", ("row 2", "column 'alpha'", "got -90", "Are these degrees?")),
    "a unit too large": ("30,40", "30,4e7", ("row 2", "column 'd'", "got 4e+07", "a kilometre", "right unit")),
    "a sign": ("elbow,-1", "elbow,2", ("row 2", "column 'sign'", "got 2", "1 or -1")),
    "order": ("2,elbow", "3,elbow", ("row 2", "column 'joint'", "got 3, expected 2", "Sort the rows")),
    "one joint": ("2,elbow,-1,0.2,-1.5,30,40\n", "", ("there are 1 joints", "at least two")),
    "a joint behind the tip": ("tip,ball,1,0,0,5,60\n", "tip,ball,1,0,0,5,60\n3,x,1,0,0,0,0\n", ("behind a tip",)),
    "a tip twice": ("60\n", "60\ntip,ball,1,0,0,5,70\n", ("row 4", "column 'name'", "'ball' again")),
    "a tip's name": ("tip,ball", "tip,a.b", ("'a.b'", "cannot be used", "Rename it")),
    "nothing": (GOOD, "", ("the file is empty", "a table of Denavit–Hartenberg parameters")),
}


@pytest.mark.parametrize("case", BAD)
def test_what_a_table_is_told(tmp_path: Path, case: str) -> None:
    old, new, fragments = BAD[case]
    assert old in GOOD
    path = tmp_path / "table.csv"
    path.write_text(GOOD)
    assert _read(path, "dh", "mm", "rad").n == 2
    (tmp_path / "table.toml").unlink()
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(UlnaInputError) as caught:
        _read(path, "dh", "mm", "rad")
    says(str(caught.value), f"{path}: ", *fragments)
    assert not (tmp_path / "table.toml").exists()


def test_units_are_never_guessed_and_beta_has_its_place(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"

    def error(text: str, convention: str = "dh", *options: object, **more: object) -> str:
        path.write_text(text)
        with pytest.raises(UlnaInputError) as caught:
            import_dh(path, tmp_path / "arm.toml", convention, *options, **more)
        return str(caught.value)

    says(error(GOOD), "column 'theta0'", "not stated and never guessed", "--angle-unit rad or deg", "theta0_rad")
    says(error(GOOD, "dh", None, "rad"), "column 'a'", "--length-unit mm or m or in", "a_mm")
    in_name = GOOD.replace(",a,", ",a_m,")
    says(
        error(in_name, "dh", "mm", "rad"), "column 'a_m'", "its name says m, --length-unit says mm", "Leave the option"
    )
    says(error(GOOD, "dh", "mm", "rad", tip=(0.0, 0.0, 1.0)), "got --tip", "rows for tips (ball)", "Leave out --tip")
    bare = "theta0_rad,alpha_rad,a_mm,d_m\n0,1,2,3\n0,1,2,3\n"
    says(error(bare, tip=(0.0, 0.0, 1.0)), "different units", "--tip", "Change one")
    assert "three finite numbers" in error(bare.replace("d_m", "d_mm"), tip=(0.0, math.nan, 1.0))
    both = "theta0_rad,alpha_rad,a_mm,d_mm,beta_rad\n0,1,2,3,0.1\n0,1,2,3,0\n"
    says(error(both), "row 1 (line 2 of the file)", "a beta and a d", "Make one of them 0")
    tilted = both.replace("2,3,0.1", "2,0,0.1")
    says(error(tilted, "modified-dh"), "row 1, column 'beta'", "got 0.1 rad", "--convention dh")
    assert not (tmp_path / "arm.toml").exists()


def test_what_a_modified_table_cannot_say_is_not_written() -> None:
    arm = of_oracle(arms.parallel_axes())
    with pytest.raises(UlnaInputError) as caught:
        dh_table(arm, "modified-dh", Path("arm.toml"))
    says(str(caught.value), "arm.toml: key 'joint.2.beta': got -0.002 rad", "no column", "--convention dh", "hold = [")
