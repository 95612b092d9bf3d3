"""Joints that turn on and on: a full turn more is the same pose, and what the arm file says goes before a guess."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.small_study import ARM, SmallStudy, says
from tests.urdf_texts import Made, urdf
from tests.urdf_texts import write as write_urdf

import ulna
from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.exchange.importers.urdf import import_urdf
from ulna.ground.errors import InputWarning, UlnaInputError

TURN = 2.0 * math.pi
COUNTS = 4096.0
UP = (0.0, 0.0, 1.0)


def arm(*joints: dict[str, object]) -> Arm:
    """Three joints, with what is said of each."""
    links = [Joint(0.1, -1.57, 40.0, 250.0), Joint(0.2, 1.57, -40.0, 1.5), Joint()]
    said = [replace(joint, counts_per_turn=COUNTS, **more) for joint, more in zip(links, joints, strict=True)]  # type: ignore[arg-type]
    return Arm("arm", tuple(said), {"tip": Probe(39.0, 0.0, 223.0)})


def measured(of: Arm, q_rad: np.ndarray, unit: str, folder: Path) -> np.ndarray:
    """(N, 3) of a file of readings."""
    per_rad = {"rad": 1.0, "deg": 180.0 / math.pi, "counts": COUNTS / TURN}[unit]
    path = folder / "q.csv"
    pl.DataFrame({f"q{k + 1}": q_rad[:, k] * per_rad for k in range(of.n)}).write_csv(path)
    out = folder / "points.csv"
    ulna.measure(of, path, out=out, angle=unit, force=True)
    return pl.read_csv(out).to_numpy()


@pytest.mark.parametrize("unit", ["rad", "deg", "counts"])
@pytest.mark.parametrize("which", range(3))
def test_turns_of_an_endless_joint_change_no_point(tmp_path: Path, which: int, unit: str) -> None:
    of = arm(*({"endless": k == which} for k in range(3)))
    q_rad = np.random.default_rng(which).uniform(-3, 3, (40, 3))
    more = q_rad.copy()
    more[:, which] += TURN * np.random.default_rng(9).integers(-500, 500, len(q_rad))
    np.testing.assert_allclose(measured(of, more, unit, tmp_path), measured(of, q_rad, unit, tmp_path), atol=1e-8)


def test_limits_count_as_far_as_they_go(tmp_path: Path) -> None:
    """Inside them nothing is asked, nor said; beyond them and two turns it is asked, where it may be a unit."""
    q_rad = np.array([[0.1, 0.2, 0.3], [90.0, -0.2, 0.1]])
    of = arm({"limits_rad": (-100.0, 100.0)}, {}, {})
    np.testing.assert_allclose(
        measured(of, q_rad, "rad", tmp_path), [of.tip(row % TURN) for row in q_rad], atol=1e-9, rtol=0
    )
    with pytest.raises(UlnaInputError, match=r"row 2.*'q1'.*90 rad.*endless = true, or limits"):
        measured(arm({}, {}, {}), q_rad, "rad", tmp_path)
    with pytest.raises(UlnaInputError, match=r"'q1'.*90 rad.*limits of joint 1, -3 to 3 rad"):
        measured(arm({"limits_rad": (-3.0, 3.0)}, {}, {}), q_rad, "rad", tmp_path)


def test_one_joint_that_goes_round_has_counted_turns_and_several_are_another_unit(tmp_path: Path) -> None:
    round_it_goes = {"limits_rad": (-TURN, TURN)}
    of = arm(round_it_goes, round_it_goes, round_it_goes)
    q_rad = np.random.default_rng(4).uniform(-2, 2, (10, 3))
    more = q_rad.copy()
    more[3, 1] += 10 * TURN
    with pytest.warns(InputWarning, match=r"1 reading outside the limits of joint 2.*row 4.*endless = true"):
        found = measured(of, more, "rad", tmp_path)
    np.testing.assert_allclose(found, of.tip(q_rad), atol=1e-9)
    # degrees that say they are radians
    with pytest.raises(UlnaInputError, match="Are these degrees or counts"):
        measured(of, np.degrees(q_rad), "rad", tmp_path)


def test_a_study_takes_them_too(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.cell(3, "q2", repr(1.0 + 40 * TURN))
    says(small.error(), "row 3", "'q2'", "more than two turns", "joint 2", "endless = true")
    small.swap("arm.toml", "d = 1.5\n", "d = 1.5\nendless = true\n")
    study, warned = small.load()
    assert not warned
    assert study.readings[0].q_rad[2, 1] == 1.0 + 40 * TURN


def test_the_key_in_files(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(ARM.replace("d = 1.5\n", "d = 1.5\nendless = true\n"))
    loaded = Arm.load(path)
    assert [joint.endless for joint in loaded.joints] == [False, True, False]
    loaded.save(tmp_path / "again.toml")
    assert Arm.load(tmp_path / "again.toml") == loaded
    path.write_text(ARM.replace("limits = ", "endless = true\nlimits = "))
    with pytest.raises(UlnaInputError, match=r"key 'joint.1.endless'.*limits.*one of them"):
        Arm.load(path)


def test_a_continuous_joint_of_a_robot_description_is_endless(tmp_path: Path) -> None:
    text = urdf([Made((0.0, 0.0, 0.1), (0.0, 0.0, 0.0), UP), Made((0.3, 0.0, 0.0), (1.5, 0.0, 0.0), UP)])
    some = text.replace('type="continuous"', 'type="revolute"', 1).replace(
        "<axis", '<limit lower="-1" upper="2"/><axis', 1
    )
    found = import_urdf(write_urdf(tmp_path, some), tmp_path / "arm.toml").arm
    assert [(joint.endless, joint.travel_rad) for joint in found.joints] == [
        (False, (-1.0, 2.0)),
        (True, (-math.pi, math.pi)),
    ]
    assert Arm.load(tmp_path / "arm.toml") == found
