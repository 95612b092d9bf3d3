"""Every way from one description of an arm to another keeps it: where its tip is *and* how it is turned, in any pose.

Arms are made up as drawings have them and as calibrations leave them: axes askew, square, parallel and opposite, nearly
so, crossing and on one line, joints of both forms in any order, encoders that count either way. Four probes, a corner
and a step along each axis, show how the last body is turned. What an arm is comes from matrices multiplied out in
`tests/oracle`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.oracle.drawn import drawn_tips
from tests.oracle.tables import table_frames
from tests.urdf_texts import poses, tips_in_root

from ulna import Arm, Joint, Probe
from ulna.arm.frames.links import PARALLEL
from ulna.exchange.export.dh import dh_table, without_beta
from ulna.exchange.export.urdf import urdf_text
from ulna.exchange.importers.dh import Imported, import_dh
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain

F64 = NDArray[np.float64]
Convention = Literal["dh", "modified-dh"]

STEP_MM = 100.0
CORNER_MM = np.array([30.0, -20.0, 150.0])
TIPS_MM = {"corner": CORNER_MM} | {name: CORNER_MM + STEP_MM * np.eye(3)[k] for k, name in enumerate("xyz")}

#: of the reach, and rad: no way loses more than this
EQUAL = 1e-9

turn = st.floats(-3.0, 3.0)
length = st.just(0.0) | st.floats(-500.0, 500.0)
tilt = st.floats(0.001, 0.04) | st.floats(-0.04, -0.001)
askew = turn.filter(lambda angle: abs(math.sin(angle)) > 0.06)
half = st.sampled_from([0.0, math.pi])
#: angles between axes: askew, square, parallel or opposite, exactly, nearly, on both sides of the limit
twist = st.one_of(
    askew,
    st.sampled_from([math.pi / 2, -math.pi / 2]),
    half,
    st.builds(lambda at, by: at + by, half, tilt | st.sampled_from([1e-16, -1e-12, 1e-9, 1e-6, 0.0499, 0.0501])),
)
slight = tilt | st.sampled_from([0.0, 1e-12, 1e-6])
sign = st.sampled_from([1, -1])
dh_joint = st.builds(lambda t, alpha, a, d, s: Joint(t, alpha, a, d, 0.0, s), turn, twist, length, length, sign)
on_one_line = st.builds(lambda t, at, d, s: Joint(t, at, 0.0, d, 0.0, s), turn, half, length, sign)
hayati_joint = st.builds(
    lambda t, alpha, a, beta, s: Joint(t, alpha, a, 0.0, beta, s, "hayati"),
    turn,
    twist,
    length,
    slight | st.floats(-1.2, 1.2),
    sign,
)
joint = dh_joint | on_one_line | hayati_joint


def arms(links: st.SearchStrategy[Joint], most: int = 6) -> st.SearchStrategy[Arm]:
    """Arms of two to so many and one joints, with the four probes."""
    probes = {name: Probe(*tip.tolist()) for name, tip in TIPS_MM.items()}
    return st.builds(
        lambda joints, last: Arm("any", (*joints, Joint(sign=last)), probes),
        st.lists(links, min_size=1, max_size=most),
        sign,
    )


def reach_mm(arm: Arm) -> float:
    """How far the arm reaches at the most."""
    return sum(abs(joint.a_mm) + abs(joint.d_mm) for joint in arm.joints) + float(np.linalg.norm(TIPS_MM["z"]))


def same(found: dict[str, F64], expected: dict[str, F64], reach: float) -> None:
    """Tips (N, 3) by probe: the same places, and the same directions from the corner to the others."""
    assert list(found) == list(expected)
    for name in TIPS_MM:
        off_mm = np.abs(found[name] - expected[name]).max()
        assert off_mm < EQUAL * reach / 1000.0, f"{name}: {off_mm:g} mm off, of {reach:g}"
        turned_rad = np.abs((found[name] - found["corner"]) - (expected[name] - expected["corner"])).max() / STEP_MM
        assert turned_rad < EQUAL, f"{name}: turned by {turned_rad:g}"


def by_matrices(arm: Arm, q_rad: F64) -> dict[str, F64]:
    """The tips by the formula of the model, written as a table and multiplied out."""
    frames = table_frames(_table(arm.joints), "dh", q_rad)
    return {name: frames["end"][:, :3, :3] @ tip + frames["end"][:, :3, 3] for name, tip in TIPS_MM.items()}


def _table(joints: Iterable[Joint], tips: Iterable[str] = ("tip,end,1,0,0,0,0,0",)) -> str:
    lines = ["joint,name,sign,theta0_rad,alpha_rad,a_mm,d_mm,beta_rad"]
    for k, each in enumerate(joints, start=1):
        numbers = (each.theta0_rad, each.alpha_rad, each.a_mm, each.d_mm, each.beta_rad)
        lines.append(",".join([str(k), f"joint {k}", str(each.sign), *map(repr, numbers)]))
    return "\n".join([*lines, *tips]) + "\n"


def of_program(arm: Arm, q_rad: F64) -> dict[str, F64]:
    return {name: arm.tip(q_rad, name) for name in arm.probes}


def imported(text: str, convention: Convention, folder: Path) -> Imported:
    """What `ulna import dh` says, and the arm as its file says it."""
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    found = import_dh(path, folder / "arm.toml", convention, force=True)
    return replace(found, arm=Arm.load(folder / "arm.toml"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("ways")


def _tip_row(name: str, convention: Convention) -> str:
    """The tip as a frame behind the last row: `Rz(-theta0) Tz(d) Tx(a)`, or `Rx(alpha) Tx(a) Tz(d)`."""
    x, y, z = TIPS_MM[name].tolist()
    if convention == "dh":
        return f"tip,{name},1,{math.atan2(-y, x)!r},0,{math.hypot(x, y)!r},{z!r},0"
    return f"tip,{name},1,0,{math.atan2(-y, z)!r},{x!r},{math.hypot(y, z)!r},0"


@settings(max_examples=150)
@given(arms(joint), joint)
def test_a_table_is_read_as_the_arm_that_it_is(folder: Path, arm: Arm, last: Joint) -> None:
    """What stands in the last row too: its frame is the one that the tips stand in."""
    text = _table((*arm.joints[:-1], last), [_tip_row(name, "dh") for name in TIPS_MM])
    q_rad = poses(arm.n, 6)
    found = imported(text, "dh", folder)
    expected = {name: frames[:, :3, 3] for name, frames in table_frames(text, "dh", q_rad).items()}
    same(of_program(found.arm, q_rad), expected, reach_mm(replace(arm, joints=(*arm.joints, last))))
    for form, words in (("hayati", "Hayati joints, because"), ("dh", "DH joints, because")):
        became = [
            str(k)
            for k, (one, other) in enumerate(zip(arm.joints[:-1], found.arm.joints, strict=False), start=1)
            if other.model == form and (one.beta_rad == 0.0) == (form == "hayati")
        ]
        said = [remark for remark in found.remarks if remark.startswith(words)]
        assert [re.search(r": ([\d, ]+)\.", remark)[1] for remark in said] == [", ".join(became)] * bool(became)
        assert all(remark.endswith("the arm is the same.") for remark in said)


@settings(max_examples=150)
@given(arms(dh_joint | on_one_line), dh_joint)
def test_a_modified_table_is_read_as_the_arm_that_it_is(folder: Path, arm: Arm, last: Joint) -> None:
    """Less where the table's own base stands: before joint 1 it turns and shifts."""
    text = _table((*arm.joints[:-1], last), [_tip_row(name, "modified-dh") for name in TIPS_MM])
    q_rad = poses(arm.n, 6)
    found = imported(text, "modified-dh", folder)
    expected = {name: frames[:, :3, 3] for name, frames in table_frames(text, "modified-dh", q_rad).items()}
    first = (*arm.joints[:-1], last)[0]
    c, s = math.cos(first.alpha_rad), math.sin(first.alpha_rad)
    r, p_mm = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), np.array([first.a_mm, 0.0, 0.0])
    in_table = {name: tips_mm @ r.T + p_mm for name, tips_mm in of_program(found.arm, q_rad).items()}
    same(in_table, expected, reach_mm(replace(arm, joints=(*arm.joints, last))))
    moved = any("base frame stands on axis 1" in remark for remark in found.remarks)
    assert moved == bool(first.alpha_rad or first.a_mm)


@settings(max_examples=150)
@given(arms(joint), st.booleans())
def test_an_arm_is_written_as_the_table_that_it_is(folder: Path, arm: Arm, beta: bool) -> None:
    """And read again as the same arm; with a column beta, and as a controller takes it."""
    q_rad = poses(arm.n, 6)
    expected = by_matrices(arm, q_rad)
    same(of_program(arm, q_rad), expected, reach_mm(arm))
    written = arm if beta else without_beta(arm)[0]
    reach = reach_mm(written)
    for convention in ("dh", "modified-dh"):
        if convention == "modified-dh" and any(each.beta_rad for each in written.joints):
            continue
        text = dh_table(written, convention, folder / "arm.toml")
        tips = {name: frames[:, :3, 3] for name, frames in table_frames(text, convention, q_rad).items()}
        same(tips, expected, reach)
        again = imported(text, convention, folder).arm
        same(of_program(again, q_rad), expected, reach)


@settings(max_examples=150)
@given(arms(joint), st.tuples(slight, slight, length, length) | st.none())
def test_an_arm_is_drawn_as_it_is(folder: Path, arm: Arm, base: tuple[float, float, float, float] | None) -> None:
    """And read again; where the first axis stands goes along."""
    if base is not None:
        first = arm.joints[0]
        own = replace(first.effects, base_tilt_rad=base[:2], base_offset_mm=base[2:])
        arm = replace(arm, joints=(replace(first, effects=own), *arm.joints[1:]))
    q_rad = poses(arm.n, 6)
    path = folder / "arm.urdf"
    path.write_text(urdf_text(arm), encoding="utf-8")
    expected = of_program(arm, q_rad)
    reach = reach_mm(arm) + (0.0 if base is None else float(np.hypot(*base[2:])))
    same({name: drawn_tips(path, name, q_rad) for name in TIPS_MM}, expected, reach)
    found = {}
    for name in TIPS_MM:
        again, t_root_base = arm_from_chain(read_chain(path, name))
        found[name] = tips_in_root(again, t_root_base, q_rad)
    same(found, expected, reach)


def test_parallel_is_what_these_arms_are_on_both_sides_of() -> None:
    assert math.sin(0.0499) < PARALLEL < math.sin(0.0501)
