"""How a calibrated arm's readings scatter: as the study stated it, and as its residuals showed it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.covariance_file import damaged, is_number
from ulna.arm.data import ArmData
from ulna.ground.arrays import F64

MOVES_MM = 1e-3
NOTICED = 0.1
"""A part of the scatter that adds half a percent to it."""


@dataclass(frozen=True)
class ReadingNoise:
    """Of one reading, each independent of the others."""

    encoder_rad: F64 | None = None
    """(n,) standard deviation of each encoder; None: nobody stated it."""
    seat_mm: float | None = None
    """Of a touch, per coordinate: as stated or, where no noise was, as the calibration's residuals show it, what the
    encoders add included; None: not known."""
    unexplained_mm: float = 0.0
    """Per coordinate: what the calibration's residuals showed beside the stated noise, which the model has not."""
    degrees_of_freedom: float = math.inf
    """Of whatever the residuals showed: of touches, and of the parameters' covariance, which was scaled by the same."""
    estimated: bool = False
    """Whether `seat_mm` is from residuals."""

    @property
    def known(self) -> bool:
        """Whether anything is known of it."""
        return self.encoder_rad is not None or self.variance_mm2 > 0.0

    @property
    def variance_mm2(self) -> float:
        """Of a tip coordinate, the encoders aside."""
        return (self.seat_mm or 0.0) ** 2 + self.unexplained_mm**2

    @property
    def moves_mm(self) -> float:
        """What was not determined matters where it moves a value by more: 1 µm, a tenth of a touch's scatter."""
        return max(MOVES_MM, NOTICED * math.sqrt(self.variance_mm2))

    @property
    def estimated_mm2(self) -> float:
        """The part of it that the residuals showed."""
        return self.variance_mm2 - self.stated_mm2

    @property
    def stated_mm2(self) -> float:
        """The part of it that was stated."""
        return 0.0 if self.estimated else (self.seat_mm or 0.0) ** 2

    def stated(self, encoder_rad: F64 | None, seat_mm: float | None = None) -> ReadingNoise:
        """As of a measurement of which more is stated; None leaves what is known.

        Where the calibration's study stated no noise, what its readings scattered more than is stated now is the
        model's: better touches do not make it better.
        """
        noise = self if encoder_rad is None else replace(self, encoder_rad=encoder_rad)
        if seat_mm is None:
            return noise
        more = self.unexplained_mm
        if self.estimated:
            more = math.sqrt(max(self.variance_mm2 - seat_mm**2, 0.0))
        return replace(noise, seat_mm=seat_mm, unexplained_mm=more, estimated=False)


UNKNOWN = ReadingNoise()


def noise_of_document(document: dict[str, Any], arm: ArmData, path: Path) -> ReadingNoise:
    """Of a result document. Raises UlnaInputError."""
    provenance, fit = document.get("provenance"), document.get("fit")
    noise = provenance.get("noise") if isinstance(provenance, dict) else None
    scatter = fit.get("reading_scatter") if isinstance(fit, dict) else None
    return noise_of(noise, scatter, arm, path, fit.get("degrees_of_freedom") if isinstance(fit, dict) else None)


def noise_of(noise: Any, scatter: Any, arm: ArmData, path: Path, freedom_of_fit: Any = None) -> ReadingNoise:
    """From the tables `provenance.noise` and `fit.reading_scatter` of a result. Raises UlnaInputError.

    freedom_of_fit: its degrees of freedom; those that count where it says nothing of its readings' scatter, as
    before there was that table, and no noise was stated.
    """
    stated = noise if isinstance(noise, dict) else {}
    if not (scatter is None or isinstance(scatter, dict)):
        damaged(path, "fit.reading_scatter", f"got {str(scatter)[:40]!r}, expected a table")
    shown = scatter or {}
    factor = _positive(shown, "factor", "fit.reading_scatter.factor", path)
    less = 1.0 if factor is None else min(factor, 1.0)
    encoder_rad = _encoders(stated.get("encoder_rad"), arm, path)
    seat_mm = _positive(stated, "seat_mm", "provenance.noise.seat_mm", path)
    estimated_mm = _positive(shown, "touch_mm", "fit.reading_scatter.touch_mm", path)
    freedom = _positive(shown, "degrees_of_freedom", "fit.reading_scatter.degrees_of_freedom", path)
    if scatter is None and noise is None and freedom_of_fit is not None:
        key = "fit.degrees_of_freedom"
        freedom = _positive({key: freedom_of_fit}, key, key, path) or 0.0
    return ReadingNoise(
        encoder_rad=None if encoder_rad is None else less * encoder_rad,
        seat_mm=estimated_mm if seat_mm is None else less * seat_mm,
        unexplained_mm=_positive(shown, "unexplained_mm", "fit.reading_scatter.unexplained_mm", path) or 0.0,
        degrees_of_freedom=math.inf if freedom is None else freedom,
        estimated=seat_mm is None and estimated_mm is not None,
    )


def _encoders(stated: Any, arm: ArmData, path: Path) -> F64 | None:
    if stated is None:
        return None
    each = stated if isinstance(stated, list) else [stated] * arm.n
    if len(each) != arm.n or not all(is_number(value) and value > 0 for value in each):
        damaged(path, "provenance.noise.encoder_rad", f"expected {arm.n} positive numbers, one per joint of the arm")
    return np.array(each, dtype=np.float64)


def _positive(table: dict[str, Any], key: str, where: str, path: Path) -> float | None:
    value = table.get(key)
    if value is None:
        return None
    if not (is_number(value) and value >= 0):
        damaged(path, where, f"got {str(value)[:40]!r}, expected a positive number")
    return float(value) or None
