"""Readings in the layout of ipa-robot-accuracy (github christianlandgraf): a UR10 measured by a laser tracker.

A table with semicolons and decimal commas: six joint angles in rad, the target's position in mm in the tracker's frame,
the temperature. Every reading touched a point of its own, whose coordinates the tracker gives: an artefact of kind
`points` without features, standing once, at an unknown pose (`frame = "free"`: the tracker's place).

A study can name such a table as it is (keys separator, decimal and columns); the importer adds the arm, and chooses
which rows are fitted.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl

from ulna.exchange.importers.folder import study_text, write_study_folder
from ulna.exchange.importers.robots import ur10
from ulna.formats.table import read_table
from ulna.formats.tables.text import TextTable
from ulna.formats.toml import read_bytes
from ulna.ground.arrays import Bool
from ulna.ground.errors import UlnaInputError

JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)
COLUMNS = {
    **{joint: f"q{k}" for k, joint in enumerate(JOINTS, start=1)},
    "measurement_temperature": "temperature",
    "measurement_x": "x",
    "measurement_y": "y",
    "measurement_z": "z",
}
"""The table's name → Ulna's."""

ORIENTATIONS = {f"measurement_r{axis}": f"r{axis}" for axis in "xyz"}
"""The same of the target's orientation: in degrees, about x, then about y and z as they turn along."""

WHAT = "a table with semicolons and a header shoulder_pan_joint;…;measurement_x;…"

ARTEFACT = """\
[artefact.tracker]              # every reading is a point of its own; the tracker's place is unknown
kind = "points"
frame = "free"
"""


TARGET = """
[artefact.target]               # how the tracker's target is turned; its mount on the flange is unknown
kind = "orientation"
rotation = "XYZ"
angle = "deg"
"""


def import_ipa_ur10(
    path: Path,
    out: Path,
    fit: int | None = None,
    every: int = 1,
    spread: bool = False,
    standings: int = 1,
    parquet: bool = False,
    orientations: bool = False,
    force: bool = False,
) -> tuple[int, int]:
    """A measurement file as a study folder `out`; returns how many readings are fitted and how many held out.

    `fit` readings go into study.toml, the rest, if any, into held-out.toml: every `every`-th row from the first on, or
    with `spread` the middle row of each of `fit` equal blocks of the file. `standings`: the tracker's place is taken as
    new in each of so many equal parts of the file, one placement for each. `orientations`: those of the target are read
    as well. Raises UlnaInputError; nothing is written then.
    """
    names = COLUMNS | ORIENTATIONS if orientations else COLUMNS
    header = _header(path, names)
    columns = list(names.values())
    frame = read_table(header, lambda column: column in columns, columns)
    count = len(frame)
    fitted = _chosen(count, fit, every, spread, path)
    readings = frame.select(
        pl.Series("placement", [f"s{1 + standings * row // count}" for row in range(count)]),
        pl.Series("id", [f"m{row}" for row in range(1, count + 1)]),
        *columns,
    )
    ending = "parquet" if parquet else "csv"
    parts = {"study": ("readings", fitted)}
    if not fitted.all():
        parts["held-out"] = ("held-out", ~fitted)
    studies: dict[str, str] = {}
    tables: dict[str, pl.DataFrame] = {}
    for study, (rows, mask) in parts.items():
        of_points = study_text(f"{rows}.{ending}", ARTEFACT)
        studies[f"{study}.toml"] = both(f"{rows}.{ending}") if orientations else of_points
        tables[f"{rows}.{ending}"] = readings.filter(mask)
    write_study_folder(out, ur10(), studies, tables, force=force)
    return int(fitted.sum()), int((~fitted).sum())


def _chosen(count: int, fit: int | None, every: int, spread: bool, path: Path) -> Bool:
    """(count,) true for the rows to fit."""
    if spread and (fit is None or every != 1):
        raise UlnaInputError(
            f"{path}: --spread goes with --fit and not with --every; expected, say, --fit 300 --spread."
        )
    candidates = np.arange(0, count, every)
    if fit is not None and fit > len(candidates):
        raise UlnaInputError(
            f"{path}: there are {count} rows, {len(candidates)} of them to choose from with --every {every}; expected "
            f"at least the {fit} of --fit. Give a smaller --fit or --every."
        )
    chosen = np.zeros(count, dtype=bool)
    if spread and fit is not None:
        chosen[(2 * np.arange(fit) + 1) * count // (2 * fit)] = True
    else:
        chosen[candidates[:fit]] = True
    return chosen


def both(readings: str) -> str:
    """A study that reads one table twice: the target's places, and how it was turned."""
    turns = f'\n[[readings]]\nfile = "{readings}"\nartefact = "target"\nignore = ["x", "y", "z"]\n'
    keys = 'artefact = "tracker"\nignore = ["rx", "ry", "rz"]\n'
    return study_text(readings, ARTEFACT, keys) + TARGET + turns


def _header(path: Path, names: dict[str, str]) -> TextTable:
    start = read_bytes(path, WHAT, limit=1 << 14)
    columns = [name.strip() for name in start.split(b"\n", 1)[0].decode("utf-8-sig", "replace").split(";")]
    for column in names:
        if column not in columns:
            raise UlnaInputError(
                f"{path}: line 1: the column '{column}' is missing; expected {WHAT}. Name the right file."
            )
    return TextTable(path, columns, separator=";", decimal=",").renamed(names)
