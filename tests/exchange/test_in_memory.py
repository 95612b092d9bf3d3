"""Arms from drawings in memory are those that the commands write, and what others' formulas say."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pytest

from ulna import Arm, InputWarning, UlnaInputError
from ulna.exchange.importers.dh import import_dh
from ulna.exchange.importers.urdf import import_urdf

ROWS = [
    (0.1, 300.0, 20.0, -math.pi / 2),
    (-0.4, 10.0, 250.0, 0.3),
    (0.7, 5.0, 30.0, math.pi / 2),
    (0.0, 120.0, 15.0, -0.4),
]
TIP = (3.0, -4.0, 80.0)
NAMES = ("theta0", "d", "a", "alpha")


def columns(**renamed: str) -> dict[str, list[float]]:
    return {renamed.get(name, name): [row[k] for row in ROWS] for k, name in enumerate(NAMES)}


def by_hand(q: np.ndarray, convention: str) -> np.ndarray:
    """The tip by 4 × 4 matrices, from nothing but the table."""

    def z(angle: float, along: float) -> np.ndarray:
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, along], [0, 0, 0, 1.0]])

    def x(angle: float, along: float) -> np.ndarray:
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[1, 0, 0, along], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])

    tips = []
    for pose in q:
        t = np.eye(4)
        for (theta0, d, a, alpha), angle in zip(ROWS, pose, strict=True):
            joint, link = z(angle - theta0, d), x(alpha, a)
            t = t @ joint @ link if convention == "dh" else t @ link @ joint
        tips.append((t @ [*TIP, 1.0])[:3])
    return np.array(tips)


TABLES = {
    "rows": lambda: [list(row) for row in ROWS],
    "array": lambda: np.array(ROWS),
    "dict": columns,
    "pandas": lambda: pd.DataFrame(columns()),
    "polars": lambda: pl.DataFrame(columns()),
    "records": lambda: pl.DataFrame(columns()).to_dicts(),
}


@pytest.mark.parametrize("convention", ["dh", "modified-dh"])
@pytest.mark.parametrize("make", TABLES.values(), ids=TABLES)
def test_the_tip_is_where_matrices_put_it(make: Any, convention: Any) -> None:
    q = np.random.default_rng(3).uniform(-2, 2, (20, 4))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # of a base frame that is moved, told below
        arm = Arm.from_dh(make(), convention=convention, length_unit="mm", angle_unit="rad", tip=TIP)
    expected = by_hand(q, convention)
    if convention == "modified-dh":  # the arm's base stands on axis 1: lengths are the same, places are moved
        tips = arm.tip(q)
        np.testing.assert_allclose(
            np.linalg.norm(tips[:, None] - tips, axis=2),
            np.linalg.norm(expected[:, None] - expected, axis=2),
            atol=1e-9,
        )
    else:
        np.testing.assert_allclose(arm.tip(q), expected, rtol=0, atol=1e-9)


def test_units_in_the_names_and_stated(tmp_path: Path) -> None:
    q = np.random.default_rng(4).uniform(-2, 2, (5, 4))
    arm = Arm.from_dh(columns(), convention="dh", length_unit="mm", angle_unit="rad")
    table = {
        "theta0_deg": [math.degrees(row[0]) for row in ROWS],
        "d_m": [row[1] / 1000 for row in ROWS],
        "a_mm": [row[2] for row in ROWS],
        "alpha_rad": [row[3] for row in ROWS],
    }
    np.testing.assert_allclose(Arm.from_dh(table, convention="dh").tip(q), arm.tip(q), rtol=0, atol=1e-9)
    pl.DataFrame(table).write_csv(tmp_path / "dh.csv")
    of_file = Arm.from_dh(tmp_path / "dh.csv", convention="dh")
    np.testing.assert_allclose(of_file.tip(q), arm.tip(q), rtol=0, atol=1e-9)
    assert (of_file.name, arm.name) == ("dh", "arm")
    assert Arm.from_dh(table, convention="dh", name="mine").name == "mine"
    import_dh(tmp_path / "dh.csv", tmp_path / "arm.toml", "dh")
    assert Arm.load(tmp_path / "arm.toml").joints == of_file.joints


@pytest.mark.parametrize(
    ("table", "said", "error", "expected"),
    [
        (columns(), {}, UlnaInputError, "expected angle_unit rad or deg, or a name such as theta0_rad"),
        (columns(), {"angle_unit": "rad"}, UlnaInputError, "expected length_unit mm or m or in"),
        (columns(), {"angle_unit": "grad"}, UlnaInputError, "angle_unit: got 'grad'"),
        (columns(theta0="theta"), {"angle_unit": "rad", "length_unit": "mm"}, UlnaInputError, "offset"),
        (columns(), {"convention": "classic"}, UlnaInputError, "expected 'dh' or 'modified-dh'"),
        ("nowhere.csv", {}, UlnaInputError, "no such file"),
        (3, {}, TypeError, "got an int, expected a DH table"),
        ([[1.0, 2.0]], {}, TypeError, "got a list, expected a DH table"),
        (columns(), {"tip": (1.0, 2.0)}, ValueError, "three numbers, got 2"),
    ],
)
def test_what_is_no_table_is_told(table: Any, said: dict[str, Any], error: type[Exception], expected: str) -> None:
    with pytest.raises(error, match=expected) as caught:
        Arm.from_dh(table, **{"convention": "dh", **said})
    assert "\n" not in str(caught.value)
    assert "--" not in str(caught.value), "options of a command are no arguments"


URDF = """<robot name="two">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="tool"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.25 0 0" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/><origin xyz="0.4 0.01 0.02"/></joint>
</robot>
"""


def test_a_urdf_is_what_the_command_makes_of_it(tmp_path: Path) -> None:
    (tmp_path / "two.urdf").write_text(URDF)
    arm = Arm.from_urdf(tmp_path / "two.urdf", tip_link="tool")
    import_urdf(tmp_path / "two.urdf", tmp_path / "arm.toml", "tool")
    written = Arm.load(tmp_path / "arm.toml")
    assert (arm.joints, arm.probes) == (written.joints, written.probes)
    assert isinstance(arm, Arm)
    # by hand: shoulder a about z at 300 mm; elbow b, whose axis points against y, 250 mm out
    a, b = 0.4, -0.7
    out = 250.0 + 400.0 * math.cos(b) - 10.0 * math.sin(b)
    up = 400.0 * math.sin(b) + 10.0 * math.cos(b)
    across = -20.0
    expected = [out * math.cos(a) - across * math.sin(a), out * math.sin(a) + across * math.cos(a), 300.0 + up]
    np.testing.assert_allclose(arm.tip([a, b]), expected, rtol=0, atol=1e-9)


def test_of_a_urdf_what_cannot_be_is_told_in_arguments(tmp_path: Path) -> None:
    (tmp_path / "two.urdf").write_text(URDF.replace("0.25 0 0", "250 0 0"))
    with pytest.raises(UlnaInputError, match=r"Say so: length_unit mm") as caught:
        Arm.from_urdf(tmp_path / "two.urdf")
    assert "--" not in str(caught.value)
    with pytest.raises(UlnaInputError, match="Did you mean 'tool'"):
        Arm.from_urdf(tmp_path / "two.urdf", tip_link="tol", length_unit="mm")


def test_a_base_that_is_moved_is_remarked_upon(tmp_path: Path) -> None:
    (tmp_path / "two.urdf").write_text(URDF.replace('xyz="0 0 0.3"', 'xyz="0.1 0 0.3"'))
    with pytest.warns(InputWarning, match=r"two\.urdf: The arm's base frame stands on axis 1"):
        Arm.from_urdf(tmp_path / "two.urdf")
