"""The table of residuals, one row per reading, and how it is written: CSV, and the list in a result's JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
import polars as pl

from ulna.artefacts.kinds import KINDS, kind_of
from ulna.artefacts.readings import Readings
from ulna.formats.models import Open
from ulna.study.study import Study

if TYPE_CHECKING:
    import ulna._core as _core


class ReadingEntry(Open):
    """Which reading an entry is about."""

    row: int
    """Data row of the file, from 1."""
    file: str
    artefact: str
    placement: str
    feature: str | None = None
    probe: str


class ResidualEntry(ReadingEntry):
    """One reading. Of point readings x, y, z: tip minus where the feature stands, in the base frame."""

    x_mm: float | None = None
    y_mm: float | None = None
    z_mm: float | None = None
    length_mm: float | None = None
    """Of a length row: measured minus stated."""
    distance_mm: float | None = None
    """Of a touch of a surface: from it, less the ball's radius."""
    turn_x_mm: float | None = None
    turn_y_mm: float | None = None
    turn_z_mm: float | None = None
    """Of an orientation: the turn about an axis of the base frame, times the lever by which it weighs."""
    norm_mm: float
    """The magnitude."""
    weight: float
    """Root of the reading's weight, 1/mm; 1 where no noise is stated."""
    times_scatter: float | None = None
    """How far off, in units of the scatter of its artefact's readings, what its placement and the fit took of it made
    up for."""
    outlier: bool | None = None
    """Whether farther off than one normal reading in ten thousand."""
    counted: float | None = None
    """What a loss let it count, 0 to 1."""


_TYPES: dict[Any, Any] = {int: pl.Int64, str: pl.String, float: pl.Float64, bool: pl.Boolean}
SCHEMA: dict[str, Any] = {
    name: _TYPES[next(iter(get_args(field.annotation)), field.annotation)]
    for name, field in ResidualEntry.model_fields.items()
}
"""Of the table: the same columns, null where one does not apply."""

_OWN = sorted({name for kind in KINDS.values() for name in kind.residual_columns})
"""Columns that only some kinds of readings have."""
_CHUNK_ROWS = 100_000


def residual_table(study: Study, fitted: _core.Fitted) -> pl.DataFrame:
    """All readings of the study in their order, columns as in `SCHEMA`; what does not apply is null."""
    tables = [_group_table(study, readings, fitted, group) for group, readings in enumerate(study.readings)]
    return pl.concat(tables) if tables else pl.DataFrame(schema=SCHEMA)


def _group_table(study: Study, readings: Readings, fitted: _core.Fitted, group: int) -> pl.DataFrame:
    artefact = readings.artefact
    rows = len(readings)
    residual_mm, counted = fitted.residuals(group), fitted.counted(group)
    columns: dict[str, Any] = {
        "row": readings.row,
        # a study made in memory has no files
        "file": _named([file.path.name for file in study.files] or ["in memory"], readings.file),
        "artefact": _named([artefact.name], np.zeros(rows, dtype=np.int64)),
        "placement": _named(readings.labels.names, readings.labels.codes),
        "probe": _named(list(study.arm.probes), readings.probe),
        "weight": fitted.weights(group),
        "times_scatter": fitted.lengths(group),
        "outlier": fitted.outliers(group),
    }
    if counted is not None:
        columns["counted"] = counted
    kind = kind_of(artefact)
    if kind.named:
        columns["feature"] = _named(list(artefact.features), readings.feature)
    own = [name for name in kind.residual_columns if name != "feature"]
    columns |= {name: residual_mm[:, k] for k, name in enumerate(own)}
    columns["norm_mm"] = np.linalg.norm(residual_mm, axis=1)
    return pl.DataFrame(
        {name: columns[name] if name in columns else nulls(dtype, rows) for name, dtype in SCHEMA.items()},
        schema=SCHEMA,
    )


def nulls(dtype: Any, rows: int) -> pl.Series:
    """A column of nothing. Not by an expression, which for a hundred rows costs as much as all columns."""
    return pl.Series([None], dtype=dtype).new_from_index(0, rows)


def _named(names: Sequence[str], index: Any) -> pl.Series:
    return pl.Series(names, dtype=pl.String).gather(index)


def json_rows(table: pl.DataFrame) -> Iterator[str]:
    """The table as JSON objects with commas between, in pieces of bounded size; keys that do not apply are left out."""
    between = ""
    for start in range(0, table.height, _CHUNK_ROWS):
        chunk = table.slice(start, _CHUNK_ROWS)
        # runs of rows that have the same columns, so that each object has just the keys that it needs
        runs = pl.struct(pl.col(*_OWN).is_null()).rle_id().alias("_run")
        for run in chunk.with_columns(runs).partition_by("_run", include_key=False):
            lacking = [name for name in (*_OWN, "counted") if run[name].is_null().all()]
            yield between + run.drop(lacking).write_ndjson().rstrip("\n").replace("\n", ",\n")
            between = ",\n"


def from_json_rows(rows: list[dict[str, Any]]) -> pl.DataFrame:
    """The inverse of `json_rows`, from the parsed list."""
    return pl.DataFrame(rows, schema=SCHEMA)
