"""Readings in the layout of MUKCa (Kuka, Panda and Kinova arms, github platonics-delft/kinematics_calibration).

A folder of a robot holds one folder for each place where the tool stood; in it `hole_0.csv` and `hole_1.csv`: joint
angles in rad, one pose a row, no header, all rows of a file read with the ball in one of two sockets 50 mm apart.
"""

from __future__ import annotations

import re
from pathlib import Path

import polars as pl

from ulna.arm.arm import Arm
from ulna.exchange.importers.folder import write_study_folder
from ulna.exchange.importers.robots import panda
from ulna.exchange.urdf.arm import arm_from_chain
from ulna.exchange.urdf.chain import read_chain
from ulna.formats.table import read_table
from ulna.formats.tables.text import TextTable
from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError

SEATS = {"hole_0.csv": "A", "hole_1.csv": "B"}

#: drawings beside the robots' folders, by the start of a folder's name
DRAWINGS = {"kuka": "iiwa14.urdf", "dinova": "gen3lite.urdf"}

STUDY = """\
format = "ulna-study/1"
arm = "arm.toml"
units = {{ length = "mm", angle = "rad" }}

[[readings]]
file = "{readings}"

[artefact.tool]                 # two sockets; a placement is a place where the tool stood
kind = "bar"
length = {length!r}
"""


def import_mukca(
    folder: Path,
    out: Path,
    urdf: Path | None = None,
    tip_link: str | None = None,
    length_mm: float = 50.0,
    parquet: bool = False,
    drop_copies: bool = False,
    force: bool = False,
) -> dict[str, int]:
    """A robot's folder as a study folder `out`; returns the number of readings of each placement.

    The arm is the drawing `urdf`, or what is known for the folder's name (panda_…; kuka_… and dinova_… from
    ../nominal_urdf). Raises UlnaInputError; nothing is written then.
    """
    places = _places(folder)
    arm = _arm(folder, urdf, tip_link)
    pieces: list[pl.DataFrame] = []
    counts: dict[str, int] = {}
    for place in places:
        both = [_seat(place / name, arm.n).with_columns(feature=pl.lit(seat)) for name, seat in SEATS.items()]
        table = pl.concat(both).with_columns(placement=pl.lit(place.name))
        if drop_copies:
            table = table.unique(maintain_order=True)
        pieces.append(table)
        counts[place.name] = len(table)
    readings = "readings.parquet" if parquet else "readings.csv"
    table = pl.concat(pieces).select("placement", "feature", *(f"q{k}" for k in range(1, arm.n + 1)))
    study = STUDY.format(readings=readings, length=float(length_mm))
    write_study_folder(out, arm, {"study.toml": study}, {readings: table}, force=force)
    return counts


def _places(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise UlnaInputError(
            f"{folder}: no such folder; expected a robot's folder with one folder per place of the tool."
        )
    places = sorted(
        entry for entry in folder.iterdir() if entry.is_dir() and any((entry / name).exists() for name in SEATS)
    )
    if not places:
        raise UlnaInputError(
            f"{folder}: no folder in it holds hole_0.csv and hole_1.csv; expected one such folder per place of the "
            "tool. Name a robot's folder, such as panda_1."
        )
    return places


def _seat(path: Path, joints: int) -> pl.DataFrame:
    start = read_bytes(path, "joint angles in rad, one pose a row, no header", limit=1 << 14)
    width = len(start.split(b"\n", 1)[0].split(b",")) if start.strip() else 0
    if width != joints:
        raise UlnaInputError(
            f"{path}: row 1 has {width} columns, the arm has {joints} joints; expected as many. Name its URDF."
        )
    return read_table(TextTable(path, [f"q{k}" for k in range(1, joints + 1)], lines=0), lambda _: True)


def _arm(folder: Path, urdf: Path | None, tip_link: str | None) -> Arm:
    if urdf is None:
        kind = re.split(r"[_\-0-9]", folder.resolve().name.lower())[0]
        if kind == "panda":
            return panda()
        if kind not in DRAWINGS:
            raise UlnaInputError(
                f"{folder}: no arm is known by this name; expected panda_…, kuka_… or dinova_…. Give its drawing with "
                "--urdf."
            )
        urdf = folder.resolve().parent / "nominal_urdf" / DRAWINGS[kind]
        if not urdf.exists():
            raise UlnaInputError(f"{urdf}: no such file; expected the drawing of {folder.name}. Give it with --urdf.")
    return arm_from_chain(read_chain(urdf, tip_link))[0]  # sockets anywhere: the base frame does not matter
