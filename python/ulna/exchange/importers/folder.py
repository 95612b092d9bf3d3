"""Writing a study folder: arm.toml, study.toml and the readings, whole or not at all."""

from __future__ import annotations

from pathlib import Path

import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.formats.output import output_folder

_HEAD = """\
format = "ulna-study/1"
arm = "arm.toml"
units = {{ length = "mm", angle = "rad" }}

[[readings]]
file = "{readings}"
{keys}
"""


def study_text(readings: str, artefact: str, keys: str = "") -> str:
    """A study of one table beside it, in mm and rad; `artefact`: the text of what was touched; `keys`: more lines of
    the table that names the readings."""
    return _HEAD.format(readings=readings, keys=keys) + artefact


def write_study_folder(
    folder: Path, arm: Arm, studies: dict[str, str], tables: dict[str, pl.DataFrame], force: bool = False
) -> None:
    """arm.toml, a study by file name (its text), and tables by file name (.csv or .parquet). Raises UlnaInputError."""
    names = ["arm.toml", *studies, *tables]
    with output_folder(folder, names, force=force) as staging:
        (staging / "arm.toml").write_text(arm_toml(arm), encoding="utf-8")
        for name, text in studies.items():
            (staging / name).write_text(text, encoding="utf-8")
        for name, table in tables.items():
            if name.endswith(".parquet"):
                table.write_parquet(staging / name)
            else:
                table.write_csv(staging / name)
