"""Readings in the layout of serial_robots_datasets (github pauljac7700): a UR5 and a Barrett WAM, by a laser tracker.

A table of targets: where each pose should have been (x_t, y_t, z_t, mm, in the robot's base frame), the difference of
that to where it was (x_dif, …: target minus measured), and the commanded angles in degrees. Every row is a point of its
own; the base frame of the measurements was found by their authors, so it is taken as unknown (`frame = "free"`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl

from ulna.exchange.importers.folder import study_text, write_study_folder
from ulna.exchange.importers.robots import ur5, wam
from ulna.formats.table import read_header, read_table
from ulna.ground.errors import UlnaInputError, nearest

ROBOTS = {"ur5": ur5, "wam": wam}
WHAT = "a table with a header step_order,x_t,y_t,z_t,x_dif,y_dif,z_dif,joint_1,…"
ARTEFACT = """\
[artefact.tracker]              # every reading is a point of its own; the measurements' frame is unknown
kind = "points"
frame = "free"
"""


def import_serial_robots(
    path: Path, out: Path, robot: str, held_out: Path | None = None, parquet: bool = False, force: bool = False
) -> tuple[int, int]:
    """A table as a study folder `out`, another as the readings that check it; how many readings each has.

    robot: one of `ROBOTS`. Raises UlnaInputError; nothing is written then.
    """
    if robot not in ROBOTS:
        raise UlnaInputError(f"--robot: got '{robot}', no robot of these data.{nearest(robot, ROBOTS)} Correct it.")
    arm = ROBOTS[robot]()
    ending = "parquet" if parquet else "csv"
    studies: dict[str, str] = {}
    tables: dict[str, pl.DataFrame] = {}
    for study, rows, source in (("study", "readings", path), ("held-out", "held-out", held_out)):
        if source is not None:
            tables[f"{rows}.{ending}"] = _readings(source, arm.n)
            studies[f"{study}.toml"] = study_text(f"{rows}.{ending}", ARTEFACT)
    write_study_folder(out, arm, studies, tables, force=force)
    counts = [len(table) for table in tables.values()]
    return counts[0], sum(counts[1:])


def _readings(path: Path, joints: int) -> pl.DataFrame:
    angles = [f"joint_{k}" for k in range(1, joints + 1)]
    pairs = [(f"{axis}_t", f"{axis}_dif") for axis in "xyz"]
    wanted = [*angles, *(name for pair in pairs for name in pair)]
    header = read_header(path, WHAT)
    for column in wanted:
        if column not in header.columns:
            raise UlnaInputError(
                f"{path}: {header.head}: the column '{column}' is missing; expected {WHAT} of {joints} joints. "
                "Name the right file, or the right robot."
            )
    if f"joint_{joints + 1}" in header.columns:
        raise UlnaInputError(
            f"{path}: {header.head}: there is a column 'joint_{joints + 1}', but the robot has {joints} joints. "
            "Name the right robot."
        )
    frame = read_table(header, lambda column: column in wanted, wanted)
    columns = {f"q{k}": np.radians(frame[name].to_numpy()) for k, name in enumerate(angles, start=1)}
    columns |= {there[0]: (frame[there] - frame[off]).to_numpy() for there, off in pairs}
    ids = pl.Series("id", [f"m{row}" for row in range(1, len(frame) + 1)])
    placement = pl.Series("placement", ["s1"] * len(frame))
    return pl.DataFrame([placement, ids, *(pl.Series(name, values) for name, values in columns.items())])
