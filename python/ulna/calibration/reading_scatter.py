"""What the residuals of a calibration say of a reading's noise."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

import ulna._core as _core
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.calibration.between_places import BetweenPlaces
from ulna.calibration.summary import FEW_PLACES, ReadingScatter
from ulna.ground.arrays import F64
from ulna.study.study import Study


def reading_scatter(core: _core.Fitted, study: Study, between: BetweenPlaces | None) -> ReadingScatter | None:
    """From the scatter of whitened residuals over their degrees of freedom; None where none are left.

    With stated noise the variance factor s² (1 where chi² does not contradict it) makes the readings' variance s² times
    the stated one; what is more, (s² - 1) times the stated variance of a tip coordinate, averaged over the readings,
    the model does not explain.
    """
    variance = core.variance
    if not math.isfinite(variance) or variance < 0.0:
        return None
    # what an instrument of orientations scatters by is no touch's
    groups = [(number, group) for number, group in enumerate(study.readings) if not kind_of(group.artefact).turned]
    freedom = _freedom(core, between)
    shown = ReadingScatter(
        degrees_of_freedom=None if math.isinf(freedom) else freedom,
        places=None if between is None else between.places,
        place_factor=None if between is None else between.factor,
    )
    if not groups:
        return shown
    if study.noise is None:
        variance *= _part(core, study, [number for number, _ in groups])
        ends = sum(len(group) * _ends(group) for _, group in groups) / sum(len(group) for _, group in groups)
        return replace(shown, touch_mm=math.sqrt(variance / ends))
    if not core.estimated:
        return replace(shown, factor=1.0)
    stated_mm2 = np.concatenate([_stated_mm2(core, number, group) for number, group in groups])
    more_mm2 = max(variance - 1.0, 0.0) * float(np.mean(stated_mm2[np.isfinite(stated_mm2)]))
    return replace(shown, factor=math.sqrt(variance), unexplained_mm=math.sqrt(more_mm2))


def _freedom(core: _core.Fitted, between: BetweenPlaces | None) -> float:
    """Degrees of freedom of the scatter; infinite of what was stated. Of few places one may be unlike the next."""
    if not core.estimated:
        return math.inf
    if between is None or between.places > FEW_PLACES:
        return core.degrees_of_freedom
    return min(core.degrees_of_freedom, between.places)


def _part(core: _core.Fitted, study: Study, places: list[int]) -> float:
    """The mean square of the residuals of places over that of all."""
    if len(places) == len(study.readings):
        return 1.0
    squares = [core.residuals(number).ravel() ** 2 for number in range(len(study.readings))]
    mean = float(np.mean(np.concatenate(squares)))
    return float(np.mean(np.concatenate([squares[number] for number in places]))) / mean if mean else 1.0


def _ends(group: Readings) -> int:
    """How many touches one residual is of."""
    return 1 if group.p_rad is None else 2


def _stated_mm2(core: _core.Fitted, number: int, group: Readings) -> F64:
    """(N,) stated variance of a tip coordinate."""
    counted = core.counted(number)
    with np.errstate(divide="ignore"):
        variance = (1.0 if counted is None else counted) / core.weights(number) ** 2
    found: F64 = np.asarray(variance / _ends(group))
    return found
