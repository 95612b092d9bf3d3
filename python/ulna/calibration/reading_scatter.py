"""What the residuals of a calibration say of a reading's noise."""

from __future__ import annotations

import math

import numpy as np

import ulna._core as _core
from ulna.artefacts.readings import Readings
from ulna.calibration.summary import ReadingScatter
from ulna.ground.arrays import F64
from ulna.study.study import Study


def reading_scatter(core: _core.Fitted, study: Study) -> ReadingScatter | None:
    """From the scatter of whitened residuals over their degrees of freedom; None where none are left.

    With stated noise the variance factor s² (1 where chi² does not contradict it) makes the readings' variance s² times
    the stated one; what is more, (s² - 1) times the stated variance of a tip coordinate, averaged over the readings,
    the model does not explain. With a loss the scatter is that of the readings that count, from their median.
    """
    variance = core.variance if study.fit.loss == "none" else _of_those_that_count(core, study)
    if not math.isfinite(variance) or variance < 0.0:
        return None
    groups = list(enumerate(study.readings))
    if study.noise is None:
        ends = sum(len(group) * _ends(group) for _, group in groups) / sum(len(group) for _, group in groups)
        return ReadingScatter(touch_mm=math.sqrt(variance / ends), degrees_of_freedom=core.degrees_of_freedom)
    if not core.estimated:
        return ReadingScatter(factor=1.0)
    stated_mm2 = np.concatenate([_stated_mm2(core, number, group) for number, group in groups])
    more_mm2 = max(variance - 1.0, 0.0) * float(np.mean(stated_mm2[np.isfinite(stated_mm2)]))
    return ReadingScatter(
        factor=math.sqrt(variance), unexplained_mm=math.sqrt(more_mm2), degrees_of_freedom=core.degrees_of_freedom
    )


def _of_those_that_count(core: _core.Fitted, study: Study) -> float:
    """Variance of a whitened residual from the medians of the groups, by their numbers."""
    counts = [len(group) for group in study.readings]
    return float(np.average(np.square(core.scales), weights=counts)) if core.degrees_of_freedom else math.nan


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
