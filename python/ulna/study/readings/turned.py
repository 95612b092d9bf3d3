"""Readings that say how a target on the last link was turned, as rotation vectors, whatever way they are written in."""

from __future__ import annotations

import numpy as np
import polars as pl

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.orientation import columns_of, target
from ulna.formats.header import Header
from ulna.formats.own_units import ANGLES, check_units
from ulna.geometry.rotation import matrices_of_angles, matrices_of_quaternions, vectors_of_matrices
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.study.readings.columns import Source

NORM = 1e-2
"""A quaternion whose length is off 1 by more was cut short, or is none."""
MOST_RAD = 4.0 * np.pi


def said_of_target(
    frame: pl.DataFrame, row: I64, artefact: Artefact, header: Header, source: Source
) -> dict[str, F64 | None]:
    """`rotation_rad` (N, 3) and `rotation_u_rad` (N,) or None. Raises UlnaInputError naming row and column."""
    own, columns = target(artefact), list(columns_of(artefact))
    key = f"artefact.{artefact.name}"
    lacking = [name for name in columns if name not in frame.columns]
    if lacking:
        raise UlnaInputError(
            f"{header.path}: the column '{lacking[0]}' is missing: artefact '{artefact.name}' is of kind "
            f"'orientation', written as {own.rotation!r} ({key}.rotation in {source.study}); expected columns "
            f"{', '.join(columns)}. Add or map them.{header.further}"
        )
    unit = "rad" if own.rad_per == 1.0 else "deg"
    values = frame.select(columns).to_numpy()
    if own.rotation == "quaternion":
        length = np.linalg.norm(values, axis=1)
        if (np.abs(length - 1.0) > NORM).any():
            first = int(np.argmax(np.abs(length - 1.0) > NORM))
            raise UlnaInputError(
                f"{header.path}: {header.at(int(row[first]), 'rw')}: rw, rx, ry, rz have the length "
                f"{length[first]:.4g}; expected a quaternion, of length 1. Correct the row, or say how it is written "
                f"with {key}.rotation in {source.study}."
            )
        vectors_rad = vectors_of_matrices(matrices_of_quaternions(values))
    else:
        check_units(header, columns, unit, ANGLES, f"State the unit with the key 'angle' of [{key}].")
        rad = np.ascontiguousarray(values * own.rad_per)
        _check_size(rad, row, columns, header, unit, key)
        turned = own.rotation != "vector"
        vectors_rad = vectors_of_matrices(matrices_of_angles(rad, own.rotation)) if turned else rad
    return {"rotation_rad": vectors_rad, "rotation_u_rad": _u_rad(frame, row, artefact, header, source)}


def _check_size(rad: F64, row: I64, columns: list[str], header: Header, unit: str, key: str) -> None:
    beyond = np.abs(rad) > MOST_RAD
    if beyond.any():
        first, k = (int(each) for each in np.argwhere(beyond)[0])
        raise UlnaInputError(
            f"{header.path}: {header.at(int(row[first]), columns[k])}: got {rad[first, k]:g} rad, more than two turns "
            f"(read in {unit}); expected angles within ±4π rad. State their unit with the key 'angle' of [{key}]."
        )


def _u_rad(frame: pl.DataFrame, row: I64, artefact: Artefact, header: Header, source: Source) -> F64 | None:
    own = target(artefact)
    if "ur" not in frame.columns:
        return np.full(len(row), own.u_rad) if own.u_rad else None
    if own.u_rad:
        raise UlnaInputError(
            f"{source.study}: key 'artefact.{artefact.name}.u': got {own.u_rad / own.rad_per:g}, but {header.path} has "
            "a column 'ur' as well. Remove one of them."
        )
    unit = "rad" if own.rad_per == 1.0 else "deg"
    check_units(header, ["ur"], unit, ANGLES, f"State the unit with the key 'angle' of [artefact.{artefact.name}].")
    u_rad: F64 = frame["ur"].to_numpy() * own.rad_per
    if not (u_rad > 0.0).all():
        first = int(np.argmax(~(u_rad > 0.0)))
        raise UlnaInputError(
            f"{header.path}: {header.at(int(row[first]), 'ur')}: got {u_rad[first] / own.rad_per:g}; expected a "
            "standard uncertainty above 0. Correct it."
        )
    return u_rad
