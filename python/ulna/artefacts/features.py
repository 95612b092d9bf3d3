"""The table of features that an artefact may name: which columns it has, and how it is written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl

from ulna.formats.header import Header
from ulna.formats.layout import Layout, TableKeys
from ulna.formats.table import read_header
from ulna.formats.unused import remark_strange
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError

WHAT = "a features file (a table with columns feature,x,y,z or feature,x,y,z,u)"
COLUMNS = ("feature", "x", "y", "z", "u")


def open_features(file: Path, keys: TableKeys | None, key: str, study: Path, remarks: list[str]) -> Header:
    """The table of an artefact's features. `key`: `artefact.plate`. Raises UlnaInputError; remarks are added to."""
    layout = Layout.of(keys or TableKeys(), (f"{study}: key '{key}.features_format.", "'"), f"{key}.features_format")
    header = read_header(file, WHAT, layout, COLUMNS)
    for column in COLUMNS[:4]:
        if column not in header.columns:
            strange = next((other for other in header.columns if other not in COLUMNS), None)
            unknown = "" if strange is None else f"unknown column '{strange}', and "
            raise UlnaInputError(
                f"{file}: {unknown}the column '{column}' is missing; the file has {', '.join(header.columns)[:80]}, "
                f"expected feature,x,y,z and perhaps u. Add it, or map the columns with {key}.features_format.columns."
            )
    remark_strange(header, COLUMNS, COLUMNS, remarks)
    return header


def uncertainties(header: Header, frame: pl.DataFrame, row: I64) -> F64:
    """The column `u`, (N,) in the unit of the file; `row` says where each stands in it. Raises UlnaInputError."""
    u: F64 = frame["u"].to_numpy()
    if (u < 0).any():
        first = int(np.argmax(u < 0))
        raise UlnaInputError(
            f"{header.path}: {header.at(int(row[first]), 'u')}: got {u[first]:g}, expected a standard uncertainty of 0 "
            "or more. Correct it."
        )
    return u
