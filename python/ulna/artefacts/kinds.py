"""Artefact tables of a study, and the features file that one may name."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.features import COLUMNS, open_features, uncertainties
from ulna.artefacts.readings import InputFile
from ulna.formats.layout import TableKeys
from ulna.formats.models import Strict, check_kind
from ulna.formats.names import check_name
from ulna.formats.table import file_sha256, read_table
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError

KINDS = ("bar", "seat", "points", "length", "sphere", "plane")

Positive = Annotated[float, Field(gt=0)]
Uncertainty = Annotated[float, Field(ge=0)]


class BarTable(Strict):
    """Two seats a known length apart: features A and B."""

    kind: Literal["bar"]
    length: Positive
    u: Uncertainty = 0.0
    """Standard uncertainty of the length."""
    fit: bool = False
    """Whether the length may change within its uncertainty; else it stays, and its uncertainty counts."""


class SeatTable(Strict):
    """One cone or socket whose place is unknown: the feature `seat`."""

    kind: Literal["seat"]


class LengthTable(Strict):
    """Rows that give two poses of the arm and the distance between their tips."""

    kind: Literal["length"]
    length: Positive | None = None
    """Fills the column `length` where the file has none."""
    u: Uncertainty = 0.0
    """Standard uncertainty of each length, common to all of them."""
    fit: bool = False
    """Whether all lengths may change by one amount within it."""


class SphereTable(Strict):
    """A ball, or a hollow, touched on its surface; its place is unknown."""

    kind: Literal["sphere"]
    diameter: Positive
    u: Uncertainty = 0.0
    """Standard uncertainty of the diameter."""
    fit: bool = False
    """Whether the diameter is fitted: within its uncertainty, or freely where none is stated."""
    inside: bool = False
    """Whether it is a hollow, touched from within."""


class PlaneTable(Strict):
    """A flat touched on its surface; its place is unknown."""

    kind: Literal["plane"]


def _features_kind(features: Any) -> str:
    return "<file>" if isinstance(features, str) else "<table>"


Coordinates = Annotated[list[float], Field(min_length=3, max_length=3)]
Features = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[Annotated[dict[str, Coordinates], Field(min_length=1)], Tag("<table>")],
    Discriminator(_features_kind),
]


class PointsTable(Strict):
    """Features with calibrated coordinates: ball bar, ball plate, points from a laser tracker."""

    kind: Literal["points"]
    features: Features | None = None
    """Coordinates by name, or the path of a table with columns feature, x, y, z and perhaps u; left out where every
    reading brings the coordinates of a point of its own, in columns x, y, z and perhaps u."""
    features_format: TableKeys | None = None
    """How the table of features is written, where it is not a CSV file with commas."""
    frame: Literal["free", "arm"] = "free"
    """"arm": the coordinates are in the arm's base frame; "free": each placement stands at an unknown pose."""
    u: Uncertainty | None = None
    """Standard uncertainty of each coordinate."""
    fit: bool = False
    """Whether features may move within their uncertainty; else they stay, and it counts."""


def _kind(table: Any) -> str:
    kind = table.get("kind") if isinstance(table, dict) else getattr(table, "kind", None)
    return f"<{kind}>"


ArtefactTable = Annotated[
    Annotated[BarTable, Tag("<bar>")]
    | Annotated[SeatTable, Tag("<seat>")]
    | Annotated[PointsTable, Tag("<points>")]
    | Annotated[LengthTable, Tag("<length>")]
    | Annotated[SphereTable, Tag("<sphere>")]
    | Annotated[PlaneTable, Tag("<plane>")],
    Discriminator(_kind),
]


def check_kinds(document: dict[str, Any], path: Path) -> None:
    """The kinds of all artefacts, before the rest of the tables is looked at. Raises UlnaInputError."""
    tables = document.get("artefact")
    for name, table in tables.items() if isinstance(tables, dict) else ():
        check_kind(table, f"artefact.{name}", KINDS, path)


def make_artefact(
    name: str, table: ArtefactTable, units: Units, path: Path, warnings: list[str]
) -> tuple[Artefact, InputFile | None]:
    """An artefact in mm, and the features file that it was made from, if any. Raises UlnaInputError."""
    check_name(name, f"artefact.{name}", path)
    _check_fit(name, table, path)
    if isinstance(table, BarTable):
        length_mm = table.length * units.mm
        ends = {"A": (0.0, 0.0, 0.0), "B": (length_mm, 0.0, 0.0)}
        return Artefact(name, "bar", ends, length_mm, table.u * units.mm, fitted=table.fit), None
    if isinstance(table, SeatTable):
        return Artefact(name, "seat", {"seat": (0.0, 0.0, 0.0)}), None
    if isinstance(table, PlaneTable):
        return Artefact(name, "plane", {}), None
    if isinstance(table, SphereTable):
        u_mm, diameter_mm = table.u * units.mm, table.diameter * units.mm
        ball = Artefact(name, "sphere", {}, None, u_mm, diameter_mm=diameter_mm, inside=table.inside, fitted=table.fit)
        return ball, None
    if isinstance(table, LengthTable):
        distance_mm = None if table.length is None else table.length * units.mm
        return Artefact(name, "length", {}, distance_mm, table.u * units.mm, fitted=table.fit), None
    if table.features_format is not None and not isinstance(table.features, str):
        raise UlnaInputError(
            f"{path}: key 'artefact.{name}.features_format': says how a file is written, but the key 'features' names "
            "none. Remove it, or name the file of the features."
        )
    if table.features is None:  # own_points.py makes them of the readings
        own = Artefact(name, "points", {}, None, (table.u or 0.0) * units.mm, table.frame, fitted=table.fit)
        return own, None
    if isinstance(table.features, str):
        return _from_file(name, table, path.parent / table.features, units, path, warnings)
    for feature in table.features:
        check_name(feature, f"artefact.{name}.features.{feature}", path)
    features = {key: (x * units.mm, y * units.mm, z * units.mm) for key, (x, y, z) in table.features.items()}
    u_mm = (table.u or 0.0) * units.mm
    return Artefact(name, "points", features, None, u_mm, table.frame, fitted=table.fit), None


def _check_fit(name: str, table: ArtefactTable, path: Path) -> None:
    """What is fitted needs an uncertainty to be fitted within, but a sphere's diameter. Raises UlnaInputError."""
    fit = getattr(table, "fit", False)
    in_file = isinstance(table, PointsTable) and not isinstance(table.features, dict)
    if fit and not isinstance(table, SphereTable) and not in_file and not getattr(table, "u", 0.0):
        raise UlnaInputError(
            f"{path}: key 'artefact.{name}.fit': true, but its uncertainty u is not stated; expected the standard "
            "uncertainty that it may move within. Add u, or remove the key."
        )


def _from_file(
    name: str, table: PointsTable, file: Path, units: Units, path: Path, warnings: list[str]
) -> tuple[Artefact, InputFile]:
    header = open_features(file, table.features_format, f"artefact.{name}", path, warnings)
    if "u" in header.columns and table.u is not None:
        raise UlnaInputError(
            f"{path}: key 'artefact.{name}.u': got {table.u:g}, but {file} has a column 'u' as well. Remove one of "
            "them."
        )
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
    xyz_mm = (frame.select("x", "y", "z").to_numpy() * units.mm).tolist()
    features = {feature: (x, y, z) for feature, (x, y, z) in zip(names, xyz_mm, strict=True)}
    u_mm = (table.u or 0.0) * units.mm
    each: tuple[float, ...] | None = None
    if "u" in frame.columns:
        each = tuple((uncertainties(header, frame, np.arange(1, len(frame) + 1)) * units.mm).tolist())
    if table.fit and not (u_mm or (each and any(each))):
        raise UlnaInputError(
            f"{path}: key 'artefact.{name}.fit': true, but neither the key 'u' nor a column 'u' of {file} says how "
            "uncertain its features are; expected the standard uncertainty that they may move within. Add it, or "
            "remove the key."
        )
    artefact = Artefact(name, "points", features, None, u_mm, table.frame, each, fitted=table.fit)
    return artefact, InputFile(file, file_sha256(file), len(frame))
