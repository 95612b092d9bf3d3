"""The before/after table: what a metrologist reads of errors, on any readings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ulna.artefacts.quantities import QUANTITIES, Quantity
from ulna.calibration.placements import Figures
from ulna.calibration.result import Result


@dataclass(frozen=True)
class Summary:
    """What a table of errors shows, mm."""

    mean_mm: float
    """Signed for signed errors; of sizes, which are positive, just their mean; NaN where it is not known."""
    rms_mm: float
    max_mm: float
    """Largest size."""

    @property
    def two_sigma_mm(self) -> float:
        """2 √(RMS² - mean²): twice the standard deviation about the mean (of n, not n - 1); NaN if not known."""
        variance = (self.rms_mm - self.mean_mm) * (self.rms_mm + self.mean_mm)
        return variance if np.isnan(variance) else 2.0 * float(np.sqrt(max(variance, 0.0)))


@dataclass(frozen=True)
class QualityRow:
    """One quantity on one set of readings, before and after."""

    quantity: str
    """One of `ulna.artefacts.quantities`, or "residual": its size."""
    readings: str
    """"fitted"; "check" (rows of the study that were kept), "left-out" (cross-validation) or "evaluated": held out."""
    before: Summary | None
    after: Summary | None
    signed: bool
    """Whether the mean is of signed errors."""


def quality_rows(readings: str, before: Figures | None, after: Figures) -> list[QualityRow]:
    """A row for every quantity that these readings give."""
    rows = []
    # what has a mean comes first, lengths before all
    for quantity in sorted(QUANTITIES, key=lambda each: (not each.distributed, not each.signed)):
        old, new = (None if each is None else _summary(quantity, each) for each in (before, after))
        if old is not None or new is not None:
            rows.append(QualityRow(quantity.name, readings, old, new, quantity.signed))
    return rows


def residual_row(result: Result) -> QualityRow | None:
    """Sizes of the fitted readings' residuals; of the start only their RMS is kept."""
    size_mm = result.residuals["norm_mm"].to_numpy()
    if not len(size_mm):
        return None
    before = Summary(math.nan, result.fit.rms_start_mm, math.nan)
    after = Summary(float(size_mm.mean()), result.fit.rms_mm, float(size_mm.max()))
    return QualityRow("residual", "fitted", before, after, False)


def _summary(quantity: Quantity, found: Mapping[str, float]) -> Summary | None:
    if not quantity.distributed:
        # of each placement one number, and the largest of them is all that is kept
        value = found.get(quantity.figure("largest"))
        return None if value is None else Summary(math.nan, math.nan, value)
    most = "max_abs" if quantity.signed else "max"
    mean, rms, largest = (found.get(quantity.figure(each)) for each in ("mean", "rms", most))
    return None if mean is None or rms is None or largest is None else Summary(mean, rms, largest)
