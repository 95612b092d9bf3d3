"""Readings that are far off the rest of their kind: listed, never dropped."""

from __future__ import annotations

from typing import Any

import polars as pl

COLUMNS = ("row", "file", "artefact", "placement", "feature", "probe", "norm_mm", "times_scatter", "counted")


def outliers(residuals: pl.DataFrame) -> list[dict[str, Any]]:
    """The rows of a table of residuals (`ulna.calibration.residuals`) that are farther off than one normal reading in
    ten thousand, the farthest first, with where to find them; keys that do not apply are left out."""
    found = residuals.filter("outlier").sort("times_scatter", descending=True, maintain_order=True)
    return [{key: value for key, value in row.items() if value is not None} for row in found.select(COLUMNS).to_dicts()]
