"""The table of features that an artefact may name: which columns it has, how it is written, what it says."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl

from ulna.artefacts.readings import InputFile
from ulna.artefacts.tables import Place
from ulna.formats.header import Header
from ulna.formats.layout import Layout, TableKeys
from ulna.formats.own_units import LENGTHS, LENGTHS_STATED, check_units
from ulna.formats.table import file_sha256, read_header, read_table
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


@dataclass(frozen=True)
class FeaturesFile:
    """What a table of features says."""

    features_mm: dict[str, tuple[float, float, float]]
    u_mm: tuple[float, ...] | None
    """Of each feature; None where the file has no such column."""


def features_of_file(file: Path, keys: TableKeys | None, key: str, place: Place) -> FeaturesFile:
    """Read a table of features; it is added to the files of `place`. `key`: `artefact.plate`. Raises UlnaInputError."""
    mm = place.units.mm
    header = open_features(file, keys, key, place.path, place.remarks)
    check_units(header, COLUMNS, place.units.length, LENGTHS, LENGTHS_STATED)
    frame = read_table(
        header, lambda column: column != "feature", [column for column in COLUMNS if column in header.columns]
    )
    names = frame["feature"].to_list()
    rows: dict[str, int] = {}
    for row, feature in enumerate(names, start=1):
        if feature in rows:
            raise UlnaInputError(
                f"{file}: {header.at(row, 'feature')}: '{feature}' stands in row {rows[feature]} already; "
                "expected each feature once. Rename or remove one."
            )
        rows[feature] = row
    if not rows:
        raise UlnaInputError(f"{file}: there are no rows; expected one per feature. Add them.")
    xyz_mm = (frame.select("x", "y", "z").to_numpy() * mm).tolist()
    features = {feature: (x, y, z) for feature, (x, y, z) in zip(names, xyz_mm, strict=True)}
    u_mm: tuple[float, ...] | None = None
    if "u" in frame.columns:
        u_mm = tuple((uncertainties(header, frame, np.arange(1, len(frame) + 1)) * mm).tolist())
    place.files.append(InputFile(file, file_sha256(file), len(frame)))
    return FeaturesFile(features, u_mm)
