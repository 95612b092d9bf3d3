"""The before/after table: what a metrologist reads of errors, on any readings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ulna.calibration.placements import Figures
from ulna.calibration.result import Result

#: quantity → its mean, RMS and largest among the figures; the others have no more than one number
DISTRIBUTED = {
    "length_error": ("length_error_mean_mm", "length_error_rms_mm", "length_error_max_abs_mm"),
    "seat_scatter": ("seat_scatter_mean_mm", "seat_scatter_rms_mm", "seat_scatter_max_mm"),
    "coordinate_error": ("coordinate_error_mean_mm", "coordinate_error_rms_mm", "coordinate_error_max_mm"),
}
WORST = {"form": "form_mm", "diameter_error": "diameter_error_mm"}


@dataclass(frozen=True)
class Summary:
    """What a table of errors shows, mm."""

    mean_mm: float
    """Signed for length errors; of distances, which are positive, just their mean; NaN where it is not known."""
    rms_mm: float
    max_mm: float
    """Largest size."""

    @property
    def two_sigma_mm(self) -> float:
        """2 √(RMS² - mean²): twice the standard deviation about the mean (of n, not n - 1); NaN if not known."""
        variance = self.rms_mm**2 - self.mean_mm**2
        return variance if np.isnan(variance) else 2.0 * float(np.sqrt(max(variance, 0.0)))


@dataclass(frozen=True)
class QualityRow:
    """One quantity on one set of readings, before and after."""

    quantity: str
    """"length_error", "seat_scatter", "coordinate_error", "form", "diameter_error", or "residual": its size."""
    readings: str
    """"fitted"; "check" (rows of the study that were kept), "left-out" (cross-validation) or "evaluated": held out."""
    before: Summary | None
    after: Summary | None
    signed: bool
    """Whether the mean is of signed errors."""


def quality_rows(readings: str, before: Figures | None, after: Figures) -> list[QualityRow]:
    """A row for every quantity that these readings give."""
    rows = []
    for quantity in (*DISTRIBUTED, *WORST):
        old, new = (None if each is None else _summary(quantity, each) for each in (before, after))
        if old is not None or new is not None:
            rows.append(QualityRow(quantity, readings, old, new, quantity == "length_error"))
    return rows


def residual_row(result: Result) -> QualityRow | None:
    """Sizes of the fitted readings' residuals; of the start only their RMS is kept."""
    size_mm = result.residuals["norm_mm"].to_numpy()
    if not len(size_mm):
        return None
    before = Summary(math.nan, result.fit.rms_start_mm, math.nan)
    after = Summary(float(size_mm.mean()), result.fit.rms_mm, float(size_mm.max()))
    return QualityRow("residual", "fitted", before, after, False)


def _summary(quantity: str, found: Mapping[str, float]) -> Summary | None:
    if quantity in WORST:
        # of each placement one number, and the largest of them is all that is kept
        value = found.get(WORST[quantity])
        return None if value is None else Summary(math.nan, math.nan, value)
    values = [found.get(name) for name in DISTRIBUTED[quantity]]
    mean, rms, most = values
    if mean is None or rms is None or most is None:
        return None
    return Summary(mean, rms, most)
