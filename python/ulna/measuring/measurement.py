"""What was measured of a file of readings."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import polars as pl

from ulna.ground.shown import About, Shown, Table


@dataclass(repr=False)
class Measurement(Shown):
    """What was measured of a file: a table in memory, or a file."""

    rows: int
    columns: list[str]
    """`id` and `probe` where the readings have them; `x, y, z`; `u_x, u_y, u_z` (standard uncertainties) where the
    arm came from a result; `c_xx, c_xy, c_xz, c_yy, c_yz, c_zz` (covariances) where they were asked for."""
    unit: str
    """Of the coordinates and their uncertainties; of covariances its square."""
    path: Path | None = None
    table: pl.DataFrame | None = None
    notes: list[str] = field(default_factory=list)
    """Why uncertainties were left empty, and what to do about it."""

    def as_dict(self) -> dict[str, Any]:
        """JSON types only."""
        return {
            "format": "ulna-measurement/1",
            "rows": self.rows,
            "columns": self.columns,
            "unit": self.unit,
            "out": None if self.path is None else str(self.path),
            "notes": self.notes,
        }

    def about(self) -> About:
        """The first and last of the points, or where they were written."""
        where = "in memory" if self.path is None else f"in {self.path}"
        tables = []
        if self.table is not None:
            texts = sum(dtype == pl.String for dtype in self.table.dtypes)
            rows = [
                ["–" if c is None else c if isinstance(c, str) else f"{c:.4f}" for c in r] for r in _ends(self.table)
            ]
            tables.append(Table(self.table.columns, rows, texts=texts))
        return About(f"{self.rows} points {where}, {self.unit}: {', '.join(self.columns)}", {}, tables, self.notes)


def _ends(table: pl.DataFrame) -> list[tuple[Any, ...]]:
    """Rows that may be shown: all of a short table, of a long one the first and the last."""
    few = table if len(table) <= 200 else pl.concat([table.head(100), table.tail(100)])
    return few.rows()
