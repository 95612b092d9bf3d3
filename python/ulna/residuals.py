"""The table of residuals, one row per reading, and how it is written: CSV, and the list in a result's JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl

from ulna.study import Readings, Study

if TYPE_CHECKING:
    from ulna import _core

SCHEMA: dict[str, Any] = {
    "row": pl.Int64,
    "file": pl.String,
    "artefact": pl.String,
    "placement": pl.String,
    "feature": pl.String,
    "probe": pl.String,
    "x_mm": pl.Float64,
    "y_mm": pl.Float64,
    "z_mm": pl.Float64,
    "length_mm": pl.Float64,
    "norm_mm": pl.Float64,
    "weight": pl.Float64,
}
"""`row` counts the file's data rows from 1. Point readings have x, y, z: tip minus where the feature stands, in the
base frame; length rows have `length_mm`: measured minus stated. `norm_mm` is the magnitude; `weight` is the root of
the reading's weight, 1/mm, or 1 where no noise is stated."""

_LENGTH_ONLY_LACKS = ("feature", "x_mm", "y_mm", "z_mm")
_CHUNK_ROWS = 100_000


def residual_table(study: Study, fitted: _core.Fitted) -> pl.DataFrame:
    """All readings of the study in their order, columns as in `SCHEMA`; what does not apply is null."""
    tables = [
        _group_table(study, readings, fitted.residuals(group), fitted.weights(group))
        for group, readings in enumerate(study.readings)
    ]
    return pl.concat(tables) if tables else pl.DataFrame(schema=SCHEMA)


def _group_table(study: Study, readings: Readings, residual_mm: Any, weight: Any) -> pl.DataFrame:
    artefact = readings.artefact
    rows = len(readings)
    columns: dict[str, Any] = {
        "row": readings.row,
        # a study made in memory has no files
        "file": _named([file.path.name for file in study.files] or ["in memory"], readings.file),
        "artefact": pl.repeat(artefact.name, rows, eager=True),
        "placement": pl.Series(readings.placement.tolist(), dtype=pl.String),
        "probe": _named(list(study.arm.probes), readings.probe),
        "weight": weight,
    }
    if artefact.kind == "length":
        columns["length_mm"] = residual_mm[:, 0]
        columns["norm_mm"] = np.abs(residual_mm[:, 0])
    else:
        columns["feature"] = _named(list(artefact.features), readings.feature)
        columns |= {f"{axis}_mm": residual_mm[:, k] for k, axis in enumerate("xyz")}
        columns["norm_mm"] = np.linalg.norm(residual_mm, axis=1)
    missing = {name: pl.repeat(None, rows, dtype=dtype, eager=True) for name, dtype in SCHEMA.items()}
    return pl.DataFrame({name: columns.get(name, missing[name]) for name in SCHEMA}, schema=SCHEMA)


def _named(names: Sequence[str], index: Any) -> pl.Series:
    return pl.Series(names, dtype=pl.String).gather(index)


def json_rows(table: pl.DataFrame) -> Iterator[str]:
    """The table as JSON objects with commas between, in pieces of bounded size; keys that do not apply are left out."""
    between = ""
    for start in range(0, table.height, _CHUNK_ROWS):
        chunk = table.slice(start, _CHUNK_ROWS)
        # runs of one kind, so that each object has just the keys of its kind
        is_length = chunk["length_mm"].is_not_null()
        for run in chunk.with_columns(is_length.rle_id().alias("_run")).partition_by("_run", include_key=False):
            lacking = _LENGTH_ONLY_LACKS if run["length_mm"][0] is not None else ("length_mm",)
            yield between + run.drop(lacking).write_ndjson().rstrip("\n").replace("\n", ",\n")
            between = ",\n"


def from_json_rows(rows: list[dict[str, Any]]) -> pl.DataFrame:
    """The inverse of `json_rows`, from the parsed list."""
    return pl.DataFrame(rows, schema=SCHEMA)
