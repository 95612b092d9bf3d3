"""Readings that are far off the rest of their kind: listed, never dropped."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import polars as pl

from ulna.artefacts.readings import InputFile

COLUMNS = ("row", "file", "artefact", "placement", "feature", "probe", "norm_mm", "times_scatter", "counted")


def outliers(residuals: pl.DataFrame, files: Sequence[InputFile] = ()) -> list[dict[str, Any]]:
    """The rows of a table of residuals (`ulna.calibration.residuals`) that are farther off than one normal reading in
    ten thousand, the farthest first, with where to find them; keys that do not apply are left out.

    files: those that were read, for `place`: where a row stands in its file, as the file's own program counts.
    """
    found = residuals.filter("outlier").sort("times_scatter", descending=True, maintain_order=True)
    rows = [{key: value for key, value in row.items() if value is not None} for row in found.select(COLUMNS).to_dicts()]
    names = [file.path.name for file in files]
    places = {name: file.places for name, file in zip(names, files, strict=True) if names.count(name) == 1}
    for row in rows:
        known = places.get(str(row["file"]))
        if known is not None:
            row["place"] = known.of(row["row"])
    return rows
