"""A volume map in numbers that can be read: by distance from the base, by length, and in cells. Lengths mm."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import polars as pl

from ulna.ground.arrays import F64
from ulna.ground.version import VERSION
from ulna.uncertainties.volume import Somewhere, VolumeMap

FORMAT = "ulna-volume-result/1"
ZONES = 5
"""Of distance from the base."""
CELLS = 10
"""Across the reach; as wide as high."""
FEWEST = 3
"""Places in a cell of which something is said."""


@dataclass(frozen=True)
class Spread:
    """Of uncertainties in a zone; None where nothing there is determined."""

    places: int
    not_determined: int
    """Of them."""
    median_mm: float | None
    most_mm: float | None
    """95 % of the places have no more."""
    largest_mm: float | None

    @classmethod
    def of(cls, u_mm: F64) -> Spread:
        """(N,), NaN where not determined."""
        sure = u_mm[np.isfinite(u_mm)]
        if not len(sure):
            return cls(len(u_mm), len(u_mm), None, None, None)
        median, most = np.quantile(sure, (0.5, 0.95)).tolist()
        return cls(len(u_mm), len(u_mm) - len(sure), median, most, float(sure.max()))


def by_distance(found: VolumeMap) -> list[tuple[float, float, Spread]]:
    """Nearest, farthest distance from the base's origin, and the standard uncertainty of positions there."""
    edges = np.linspace(0.0, found.reach_mm, ZONES + 1)
    distance = np.linalg.norm(found.points.at_mm, axis=1)
    zone = np.minimum(np.digitize(distance, edges) - 1, ZONES - 1)
    zones = zip(edges[:-1].tolist(), edges[1:].tolist(), range(ZONES), strict=True)
    return [(low, high, Spread.of(found.points.u_mm[zone == k])) for low, high, k in zones if (zone == k).any()]


def by_length(found: VolumeMap) -> list[tuple[float, Spread, Spread]]:
    """Length, its standard uncertainty, and the expanded one."""
    return [(length, Spread.of(bars.u_mm), Spread.of(bars.expanded_mm)) for length, bars in found.lengths.items()]


def cells(found: VolumeMap) -> pl.DataFrame:
    """One row a cell of the half plane through the base's axis: distance from the axis and height of its middle, how
    many places are in it, medians; empty where there are fewer than `FEWEST`, or not all are determined."""
    side = found.reach_mm / CELLS
    columns = {"point": (found.points, found.points.u_mm)} | {
        f"length_{length:g}": (bars, bars.expanded_mm) for length, bars in found.lengths.items()
    }
    rows: dict[tuple[int, int], dict[str, Any]] = {}
    for name, (places, values) in columns.items():
        r, z = cylindrical(places)
        at = np.stack([np.floor(r / side), np.floor(z / side)], axis=1).astype(np.int64)
        unique, inverse = np.unique(at, axis=0, return_inverse=True)
        for number, (i, j) in enumerate(unique.tolist()):
            here = values[inverse.ravel() == number]
            row = rows.setdefault((i, j), {})
            row[f"{name}_places"] = len(here)
            sure = len(here) >= FEWEST and np.isfinite(here).all()
            row[f"{name}_{'u' if name == 'point' else 'U'}_mm"] = float(np.median(here)) if sure else None
    table: dict[str, list[Any]] = {"r_mm": [], "z_mm": []}
    names = [f"{name}_{kind}" for name in columns for kind in ("places", "u_mm" if name == "point" else "U_mm")]
    table |= {name: [] for name in names}
    for (i, j), row in sorted(rows.items()):
        table["r_mm"].append((i + 0.5) * side)
        table["z_mm"].append((j + 0.5) * side)
        for name in names:
            table[name].append(row.get(name, 0 if name.endswith("_places") else None))
    return pl.DataFrame(table)


def cylindrical(places: Somewhere) -> tuple[F64, F64]:
    """(N,) distance from the base's axis, and height."""
    return np.hypot(places.at_mm[:, 0], places.at_mm[:, 1]), places.at_mm[:, 2]


def as_dict(found: VolumeMap) -> dict[str, Any]:
    """`volume.json`: JSON types only, no NaN."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "arm": found.arm,
        "probe": found.probe,
        "reach_mm": found.reach_mm,
        "p": found.p,
        "seed": found.seed,
        "points": [{"from_mm": low, "to_mm": high, "u": asdict(spread)} for low, high, spread in by_distance(found)],
        "lengths": [
            {"length_mm": length, "u": asdict(u), "expanded": asdict(expanded)}
            for length, u, expanded in by_length(found)
        ],
        "not_determined": found.not_determined,
        "left_out": found.left_out,
    }
