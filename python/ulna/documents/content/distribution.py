"""How errors are distributed: histogram with the normal curve, and the normal Q–Q plot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from ulna.artefacts.kinds import KINDS
from ulna.calibration.placements import PlacementFigures
from ulna.ground.arrays import F64, I64
from ulna.ground.quantiles import normals

MOST_BINS = 80


@dataclass(frozen=True)
class Sample:
    """Errors of one kind and their distribution."""

    artefact: str
    kind: str
    """"length" (length rows; bars touched once at each end), "component" (x, y, z of point readings) or "distance"
    (touches of a surface)."""
    value_mm: F64
    """(N,)"""
    edges_mm: F64
    """(B + 1,) of the histogram."""
    counts: I64
    """(B,)"""
    mean_mm: float
    sigma_mm: float
    """Standard deviation (divided by n - 1)."""
    quantile: F64
    """(N,) of the standard normal distribution, ascending: Filliben's medians of order statistics."""
    ordered_mm: F64
    """(N,) the errors, ascending: of a normal distribution a straight line over `quantile`."""


def samples(residuals: pl.DataFrame, placements: Sequence[PlacementFigures]) -> list[Sample]:
    """One for each artefact and kind of error, in the order of the artefacts.

    Two touches of a bar, one at each end, have one error between them, that of its length; their six components would
    show the directions in which the bars lay. So such bars count by their lengths, other point readings by components.
    """
    found = []
    for (artefact,), rows in residuals.group_by("artefact", maintain_order=True):
        name = str(artefact)
        own = [entry for entry in placements if entry.artefact == name]
        if own and all(KINDS[entry.kind].indivisible and entry.readings == 2 for entry in own):
            lengths = [entry.figures.get("length_error_mean_mm") for entry in own]
            values = [value for value in lengths if value is not None]
            found.append(_sample(name, "length", np.array(values)))
            continue
        for kind, columns in (
            ("length", ["length_mm"]),
            ("component", ["x_mm", "y_mm", "z_mm"]),
            ("distance", ["distance_mm"]),
        ):
            parts = [rows[column].drop_nulls().to_numpy() for column in columns]
            values_mm = np.concatenate(parts)
            if len(values_mm):
                found.append(_sample(name, kind, values_mm))
    return found


def _sample(artefact: str, kind: str, value_mm: F64) -> Sample:
    edges = bin_edges(value_mm)
    counts, _ = np.histogram(value_mm, edges)
    several = len(value_mm) > 1
    return Sample(
        artefact=artefact,
        kind=kind,
        value_mm=value_mm,
        edges_mm=edges,
        counts=counts.astype(np.int64),
        mean_mm=float(value_mm.mean()),
        sigma_mm=float(value_mm.std(ddof=1)) if several else 0.0,
        quantile=normal_quantiles(len(value_mm)),
        ordered_mm=np.sort(value_mm),
    )


def bin_edges(value_mm: F64) -> F64:
    """Equal bins over all values, of the width of Freedman and Diaconis (1981), 2 IQR n^(-1/3); at most `MOST_BINS`."""
    low, high = float(value_mm.min()), float(value_mm.max())
    if not high > low:
        return np.array([low - 0.5e-6, low + 0.5e-6])
    q1, q3 = np.quantile(value_mm, [0.25, 0.75])
    width = 2.0 * float(q3 - q1) / len(value_mm) ** (1 / 3)
    bins = int(np.ceil((high - low) / width)) if width > 0.0 else 1
    return np.linspace(low, high, min(max(bins, 1), MOST_BINS) + 1)


def normal_quantiles(count: int) -> F64:
    """(count,) of the standard normal distribution at Filliben's medians of the order statistics (Technometrics 17,
    1975): 1 - 0.5^(1/n) at the first, (i - 0.3175)/(n + 0.365), 0.5^(1/n) at the last."""
    if count == 0:
        return np.zeros(0)
    at = (np.arange(1, count + 1) - 0.3175) / (count + 0.365)
    at[-1] = 0.5 ** (1.0 / count)
    at[0] = 1.0 - at[-1]
    return normals(at)
