"""Orientations of a target on the last link: how they are written, how it is mounted, what they are good for."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import numpy as np
import polars as pl
import pytest
from scipy.spatial.transform import Rotation
from tests.small_study import says

import ulna
from ulna.arm.attitudes import attitudes
from ulna.artefacts.mounting import mounting
from ulna.artefacts.orientation import Rotation as Way
from ulna.artefacts.orientation import target
from ulna.geometry.rotation import SEQUENCES

MOUNT = Rotation.from_rotvec([0.7, -1.1, 0.4])
STANDS = Rotation.from_rotvec([[0.2, 1.4, -0.3], [-2.0, 0.1, 0.5]])
ARM = """format = "ulna-arm/1"
name = "six axes"
units = { length = "mm", angle = "rad" }
joint = [
    { theta0 = 0.01, alpha = 1.56, a = 3.0, d = 300.0 },
    { theta0 = 1.5, alpha = 0.01, a = 401.0, d = 5.0 },
    { theta0 = -0.02, alpha = 1.58, a = 30.0, d = 0.5 },
    { theta0 = 0.03, alpha = -1.57, a = 1.0, d = 380.0 },
    { theta0 = 0.02, alpha = 1.55, a = -1.0, d = 2.0 },
    {},
]
[probe.target]
tip = { x = 30.0, y = -10.0, z = 120.0 }
"""
STUDY = """format = "ulna-study/1"
arm = "arm.toml"
units = { length = "mm", angle = "rad" }
[[readings]]
file = "turns.csv"
[artefact.target]
kind = "orientation"
"""


def frames_by_hand(arm: ulna.Arm, q_rad: np.ndarray) -> Rotation:
    """R(q), as the formula of the chain reads."""
    turned = Rotation.identity(len(q_rad))
    for k, joint in enumerate(arm.joints):
        z, x = np.zeros((2, len(q_rad), 3))
        z[:, 2], x[:, 0] = joint.sign * q_rad[:, k] - joint.theta0_rad, joint.alpha_rad
        turned = turned * Rotation.from_rotvec(z) * Rotation.from_rotvec(x)
    return turned


def seen(arm: ulna.Arm, count: int, off_rad: float = 0.0, stands: int = 2) -> tuple[np.ndarray, np.ndarray, Rotation]:
    """Poses, the standing of the instrument at each, and what it sees."""
    rng = np.random.default_rng(5)
    q_rad, code = rng.uniform(-2.5, 2.5, (count, 6)), np.arange(count) % stands
    noise = Rotation.from_rotvec(off_rad * rng.standard_normal((count, 3)))
    return q_rad, code, STANDS[code].inv() * frames_by_hand(arm, q_rad) * MOUNT * noise


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "arm.toml").write_text(ARM)
    return tmp_path


def parameter(result: ulna.Result, name: str) -> ulna.Parameter:
    return next(each for each in result.parameters if each.name == name)


def write(folder: Path, columns: dict[str, np.ndarray], keys: str, more: str = "") -> Path:
    q_rad, code, _ = seen(ulna.Arm.load(folder / "arm.toml"), 60)
    table = {f"q{k + 1}": q_rad[:, k] for k in range(6)} | {"placement": code} | columns
    pl.DataFrame(table).write_csv(folder / "turns.csv")
    (folder / "study.toml").write_text(STUDY + keys + more)
    return folder / "study.toml"


def error(path: Path) -> str:
    with pytest.raises(ulna.UlnaInputError) as caught:
        ulna.Study.load(path)
    return str(caught.value)


def test_the_last_link_is_turned_as_the_chain_says(folder: Path) -> None:
    arm = ulna.Arm.load(folder / "arm.toml")
    q_rad, _, _ = seen(arm, 30)
    found = attitudes(arm.core, q_rad, 0, arm.conditions(len(q_rad)))
    np.testing.assert_allclose(found, frames_by_hand(arm, q_rad).as_matrix(), atol=1e-13)


def test_every_order_of_turns_can_be_said() -> None:
    assert get_args(Way) == ("vector", "quaternion", *SEQUENCES)


@pytest.mark.parametrize("way", get_args(Way))
@pytest.mark.parametrize("unit", ["rad", "deg"])
def test_every_way_of_writing_says_the_same(folder: Path, way: str, unit: str) -> None:
    """Exact orientations leave nothing, and the mount is found from nothing."""
    _, _, turned = seen(ulna.Arm.load(folder / "arm.toml"), 60)
    per = 1.0 if unit == "rad" else 180.0 / np.pi
    if way == "quaternion":
        columns = dict(zip(("rx", "ry", "rz", "rw"), turned.as_quat().T, strict=True))
    elif way == "vector":
        columns = dict(zip(("rx", "ry", "rz"), per * turned.as_rotvec().T, strict=True))
    else:
        columns = dict(zip([f"r{axis}" for axis in way.lower()], per * turned.as_euler(way).T, strict=True))
    path = write(folder, columns, f'rotation = "{way}"\nangle = "{unit}"\n', '[fit]\nhold = ["joint.*", "probe.*"]\n')
    result = ulna.calibrate(path)
    mount = [parameter(result, f"artefact.target.{axis}").value for axis in ("rx", "ry", "rz")]
    np.testing.assert_allclose(mount, MOUNT.as_rotvec(), atol=1e-9)
    assert result.after["orientation_error_max_mm"] < 1e-8


def test_the_mount_is_found_whatever_it_is(folder: Path) -> None:
    """From orientations that scatter by 0.1 mrad, whole turns of the mount and the standings included; and where the
    instrument's axes are the arm's."""
    arm = ulna.Arm.load(folder / "arm.toml")
    rng = np.random.default_rng(6)
    for number in range(40):
        q_rad, mount = rng.uniform(-2.5, 2.5, (30, 6)), Rotation.random(random_state=number)
        code, stands = np.arange(30) % 3, Rotation.random(3, random_state=100 + number)
        free = number % 4 > 0
        held = frames_by_hand(arm, q_rad)
        noise = Rotation.from_rotvec(1e-4 * rng.standard_normal((30, 3)))
        seen_there = (stands[code].inv() if free else Rotation.identity(30)) * held * mount * noise
        found = mounting(held.as_matrix(), seen_there.as_matrix(), code, free)
        assert (mount.inv() * Rotation.from_matrix(found.mount)).magnitude() < 2e-4
        off_rad = found.off_rad(held.as_matrix(), seen_there.as_matrix(), code)
        assert 0.5e-4 < np.sqrt(np.mean(off_rad**2)) < 1.2e-4


def test_what_cannot_be_read_is_said(folder: Path) -> None:
    _, _, turned = seen(ulna.Arm.load(folder / "arm.toml"), 60)
    columns = dict(zip(("rx", "ry", "rz"), turned.as_rotvec().T, strict=True))
    vector = 'rotation = "vector"\n'
    says(error(write(folder, columns, "")), "artefact.target.rotation", "missing")
    says(error(write(folder, columns, 'rotation = "quaternion"\n')), "'rw' is missing", "rw, rx, ry, rz")
    halved = {"rw": np.full(60, 0.5)} | columns
    says(
        error(write(folder, halved, 'rotation = "quaternion"\n')),
        "line 2",
        "have the length",
        "artefact.target.rotation",
    )
    degrees = {name: 57.3 * values for name, values in columns.items()}
    says(error(write(folder, degrees, vector)), "more than two turns", "'angle' of [artefact.target]")
    says(error(write(folder, columns, vector + "u_mount = 0.1\n")), "'mount' is missing")
    says(error(write(folder, columns, vector + "mount = [200, 0, 0]\n")), "more than a whole turn")
    both = columns | {"ur": np.full(60, 1e-4)}
    says(error(write(folder, both, vector + "u = 1e-4\n")), "column 'ur' as well")
    says(error(write(folder, columns | {"ur": np.zeros(60)}, vector)), "column 'ur'", "above 0")
    in_brackets = {f"{name} [deg]": values for name, values in columns.items()}
    says(error(write(folder, in_brackets, vector)), "deg", "'angle' of [artefact.target]")


def test_beside_stated_noise_its_own_uncertainty_is_needed(folder: Path) -> None:
    _, _, turned = seen(ulna.Arm.load(folder / "arm.toml"), 60)
    columns = dict(zip(("rx", "ry", "rz"), turned.as_rotvec().T, strict=True))
    path = write(folder, columns, 'rotation = "vector"\n', "[noise]\nseat = 0.01\n")
    with pytest.raises(ulna.UlnaInputError, match=r"Add the key 'artefact\.target\.u', or a column 'ur'"):
        ulna.calibrate(path)


def test_orientations_alone_tell_no_lengths(folder: Path) -> None:
    _, _, turned = seen(ulna.Arm.load(folder / "arm.toml"), 60, 1e-4)
    columns = dict(zip(("rx", "ry", "rz"), turned.as_rotvec().T, strict=True))
    found = ulna.identify(write(folder, columns, 'rotation = "vector"\nu = 1e-4\n', "[noise]\nencoder = 1e-5\n"))
    alone = [each for each in found.lost if "only orientations were read" in each["because"]]
    names = [name for each in alone for name in each["combination"]]
    lengths = [name for name in found.names if name.rpartition(".")[2] in ("a", "d", "x", "y", "z")]
    assert sorted(names) == sorted(name for name in lengths if name != "joint.1.d")
    assert found.determined == 12  # five twists, four zeros, three angles of the mount


def test_they_sharpen_what_points_leave(folder: Path) -> None:
    """A tip on the last axis does not show joint 5; with orientations it does, and errors are what is stated."""
    (folder / "arm.toml").write_text(ARM.replace("x = 30.0, y = -10.0", "x = 0.0, y = 0.0"))
    true = ulna.Arm.load(folder / "arm.toml")
    rng = np.random.default_rng(8)
    q_rad, _, turned = seen(true, 90, 1e-4, stands=1)
    points_mm = true.core.tip(q_rad, 0) + 0.02 * rng.standard_normal((90, 3))
    columns = {f"q{k + 1}": q_rad[:, k] for k in range(6)}
    columns |= dict(zip("xyz", points_mm.T, strict=True))
    columns |= dict(zip(("rx", "ry", "rz"), turned.as_rotvec().T, strict=True))
    pl.DataFrame(columns).write_csv(folder / "all.csv")
    head = 'format = "ulna-study/1"\narm = "arm.toml"\nunits = { length = "mm", angle = "rad" }\n'
    points = '[[readings]]\nfile = "all.csv"\nartefact = "tracker"\nignore = ["rx", "ry", "rz"]\n'
    turns = '[[readings]]\nfile = "all.csv"\nartefact = "target"\nignore = ["x", "y", "z"]\n'
    tracker = '[artefact.tracker]\nkind = "points"\n'
    target_table = '[artefact.target]\nkind = "orientation"\nrotation = "vector"\n'
    (folder / "points.toml").write_text(head + points + tracker)
    (folder / "both.toml").write_text(head + points + turns + tracker + target_table)
    alone, both = ulna.calibrate(folder / "points.toml"), ulna.calibrate(folder / "both.toml")
    assert parameter(alone, "joint.5.alpha").u is None
    twist = parameter(both, "joint.5.alpha")
    assert twist.u is not None
    assert abs(twist.value - true.joints[4].alpha_rad) < 4.0 * twist.u < 4e-4
    assert both.fit.reading_scatter.touch_mm == pytest.approx(0.02, rel=0.15)
    # the lever by which 0.1 mrad count as 0.02 mm
    found = target(both.study.readings[1].artefact).lever_mm
    assert found == pytest.approx(200.0, rel=0.2)


def test_a_lever_that_is_stated_stays(folder: Path) -> None:
    _, _, turned = seen(ulna.Arm.load(folder / "arm.toml"), 60, 1e-4)
    columns = dict(zip(("rx", "ry", "rz"), turned.as_rotvec().T, strict=True))
    study = ulna.Study.load(write(folder, columns, 'rotation = "vector"\nlever = 250\n'))
    assert target(study.readings[0].artefact).lever_mm == 250.0
