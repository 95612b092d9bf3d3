"""What was taken for what is said of a DH table; units that can hardly be meant are asked about; tables as they are
exported from a spreadsheet."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import run
from tests.urdf_texts import poses

from ulna.exchange.importers.dh import import_dh

TABLE = "joint,offset,alpha,a,d\n1,0,90,0,340\n2,0,-90,20,0\n3,0,0,400,0\n"
RIGHT = TABLE.replace("90", "1.5708")


def imported(folder: Path, text: str, length: str | None, angle: str | None, convention: str = "dh"):  # type: ignore[no-untyped-def]
    path = folder / "maker.csv"
    path.write_text(text, encoding="utf-8")
    return import_dh(path, folder / "arm.toml", convention, length, angle, force=True)  # type: ignore[arg-type]


@pytest.mark.parametrize("convention", ["dh", "modified-dh"])
def test_columns_units_and_convention_are_said(tmp_path: Path, convention: str) -> None:
    found = imported(tmp_path, TABLE.replace("alpha", "alpha_deg"), "in", "deg", convention)
    for part in ("offset in deg (turn = sign * encoder + offset)", "alpha in deg", "a in in", "d in in"):
        assert part in found.taken
    assert {"dh": "behind its joint", "modified-dh": "before its joint"}[convention] in found.taken
    assert "every encoder's sign is 1" in found.taken
    assert "origin of the last row's frame" in found.taken
    assert found.taken in (tmp_path / "arm.toml").read_text(encoding="utf-8").splitlines()[0]


def test_the_command_says_it(tmp_path: Path) -> None:
    (tmp_path / "maker.csv").write_text(TABLE)
    units = ["--length-unit", "mm", "--angle-unit", "deg"]
    done = run("import", "dh", tmp_path / "maker.csv", "-o", tmp_path / "arm.toml", "--convention", "dh", *units)
    assert done.returncode == 0
    assert "Read: offset in deg" in done.stderr


@pytest.mark.parametrize(
    ("text", "length", "angle", "asked"),
    [
        (TABLE, "mm", "deg", None),
        (RIGHT, "mm", "rad", None),
        (TABLE, "m", "deg", "All lengths together are 760000 mm"),
        (TABLE.replace("340", "0.340").replace("400", "0.4").replace("20", "0.02"), "mm", "deg", "are 0.76 mm"),
        (RIGHT, "mm", "deg", "alpha is 1.5708, -1.5708 degrees, and right angles are that in rad"),
        (TABLE.replace("90", "2.5"), "mm", "deg", None),
    ],
)
def test_units_that_can_hardly_be_are_asked_about(
    tmp_path: Path, text: str, length: str, angle: str, asked: str | None
) -> None:
    remarks = [remark for remark in imported(tmp_path, text, length, angle).remarks if remark.endswith("right?")]
    assert remarks == [] if asked is None else (len(remarks) == 1 and asked in remarks[0])


@pytest.mark.parametrize(
    "text",
    [
        "Joint;Offset (deg);Alpha (°);a [mm];d_mm\n1;0;90;0;340\n2;0;-90;20;0\n3;0;0;400,0;0\n",
        "joint,offset,alpha,a,d\n,deg,deg,mm,mm\n1,0,90,0,340\n2,0,-90,20,0\n3,0,0,400,0\n",
    ],
)
def test_a_table_says_its_own_units(tmp_path: Path, text: str) -> None:
    expected = imported(tmp_path, TABLE, "mm", "deg").arm
    found = imported(tmp_path, text, None, None).arm
    assert np.array_equal(found.tip(poses(3)), expected.tip(poses(3)))
