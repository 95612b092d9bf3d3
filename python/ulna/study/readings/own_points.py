"""Readings that bring the coordinates of what they touched: a laser tracker's, say. Every reading has a point of its
own, so the artefact (kind `points` without `features`) is made of the readings."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import polars as pl

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.features import uncertainties
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.formats.header import Header
from ulna.formats.own_units import LENGTHS, LENGTHS_STATED, check_units
from ulna.formats.units import Units
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.study.readings.columns import Source

Place = tuple[float, float, float]


def has_own_points(artefact: Artefact) -> bool:
    """Whether the readings of an artefact bring its features with them."""
    return kind_of(artefact).features_file and not artefact.features


def own_points(
    frame: pl.DataFrame,
    row: I64,
    artefact: Artefact,
    header: Header,
    source: Source,
    units: Units,
    remarks: list[str],
) -> tuple[Artefact, I64]:
    """The artefact with the points of these rows as features, and (N,) the feature of each row.

    A point is called by the reading's id, or m1, m2, … by its row. Raises UlnaInputError.
    """
    lacking = [name for name in ("x", "y", "z") if name not in frame.columns]
    if lacking:
        raise UlnaInputError(
            f"{header.path}: the column '{lacking[0]}' is missing: artefact '{artefact.name}' has no features of its "
            f"own, so each reading needs the coordinates of its point; expected columns x, y, z, in {units.length}. "
            f"Add or map them, or give artefact.{artefact.name}.features in {source.study}."
        )
    check_units(header, ["x", "y", "z", "u"], units.length, LENGTHS, LENGTHS_STATED)
    if "feature" in frame.columns or source.entry.feature is not None:
        remarks.append(
            f"{header.path}: the names of features are not used: artefact '{artefact.name}' has none of its own, and "
            "each reading touched another point."
        )
    xyz_mm = (frame.select("x", "y", "z").to_numpy() * units.mm).tolist()
    names = frame["id"].to_list() if "id" in frame.columns else [f"m{k}" for k in row]
    features: dict[str, Place] = {}
    for name, (x, y, z) in zip(names, xyz_mm, strict=True):
        features[name] = (x, y, z)  # a name stands twice only where one reading does: see check_ids
    numbers = {name: k for k, name in enumerate(features)}
    each = _u_mm(frame, row, artefact, header, source, units)
    of_feature: tuple[float, ...] | None = None
    if each is not None:
        of_feature = tuple(dict(zip(names, each.tolist(), strict=True)).values())
    made = dataclasses.replace(artefact, features=features, feature_u_mm=of_feature)
    return made, np.array([numbers[name] for name in names], dtype=np.int64)


def _u_mm(
    frame: pl.DataFrame, row: I64, artefact: Artefact, header: Header, source: Source, units: Units
) -> F64 | None:
    """The column `u`, (N,) mm, where there is one."""
    if "u" not in frame.columns:
        return None
    if artefact.u_mm:
        raise UlnaInputError(
            f"{source.study}: key 'artefact.{artefact.name}.u': got {artefact.u_mm / units.mm:g}, but {header.path} "
            "has a column 'u' as well. Remove one of them."
        )
    u_mm: F64 = uncertainties(header, frame, row) * units.mm
    return u_mm


def joined_points(own: list[Readings], files: list[Path]) -> tuple[Artefact, list[I64]]:
    """One artefact of the points in several files, and for each of them (N,) the feature of each row.

    files: by `Readings.file`. A name that stands for another point in an earlier file gets the file's name before it.
    """
    features: dict[str, Place] = {}
    u_mm: dict[str, float] = {}
    feature: list[I64] = []
    for part in own:
        each = part.artefact.feature_u_mm or [part.artefact.u_mm] * len(part.artefact.features)
        file = files[int(part.file[0])].name
        called: dict[str, str] = {}
        for (name, place), u in zip(part.artefact.features.items(), each, strict=True):
            new, number = name, 1
            while features.setdefault(new, place) != place:
                new = f"{file}:{name}" if number == 1 else f"{file}:{name}:{number}"
                number += 1
            called[name] = new
            u_mm.setdefault(new, u)
        numbers = {name: k for k, name in enumerate(features)}
        order = np.array([numbers[new] for new in called.values()], dtype=np.int64)
        feature.append(order[part.feature])
    return dataclasses.replace(own[0].artefact, features=features, feature_u_mm=tuple(u_mm.values())), feature
