"""How readings scatter about a fit, as `ulna calibrate` prints it: in one paragraph, what is in every uncertainty."""

from __future__ import annotations

import math

from ulna.calibration.result import Result
from ulna.calibration.summary import ReadingScatter
from ulna.ground.digits import degrees_of_freedom, uncertainty

#: parts of the stated noise that the residuals confirm, when a loss estimates it anew
_ALIKE = 0.05


def scatter(result: Result) -> str:
    """Nothing where readings scatter as was stated, and alike in all places."""
    unknown = result.covariance.why_none
    if unknown is not None and result.covariance.names:
        return f"No uncertainties can be given: {unknown.because}. {unknown.remedy}"
    found = result.fit.reading_scatter
    if found is None:
        return ""
    return " ".join(filter(None, [_of_readings(found, result.fit.loss), _of_places(found)]))


def _of_readings(found: ReadingScatter, loss: str) -> str:
    if found.touch_mm is not None:
        freedom = "" if found.degrees_of_freedom is None else f", {_freedom(found.degrees_of_freedom)}"
        if found.degrees_of_freedom is not None and found.degrees_of_freedom == found.places:
            freedom += f" for {found.places} places"
        touch = f"{uncertainty(found.touch_mm)} mm per coordinate of a touch{freedom}"
        return f"Noise is not stated: the residuals say {touch}, and that is in every uncertainty."
    factor = found.factor or 1.0
    if factor == 1.0 or (loss != "none" and abs(factor - 1.0) < _ALIKE):
        return ""
    times = f"the readings scatter {factor:.2g} times as much" if factor >= 1.05 else f"only {factor:.2g} of it is seen"
    text = f"The stated noise is contradicted: {times}. Uncertainties are scaled by that"
    if found.unexplained_mm:
        text += (
            f", and {uncertainty(found.unexplained_mm)} mm per coordinate of a touch is what the model does not explain"
        )
    return f"{text}."


def _of_places(found: ReadingScatter) -> str:
    if found.places is None:
        return ""
    few = found.few_places
    if found.place_factor is not None and found.place_factor > 1.0:
        text = (
            f"In a place that is left out the arm errs more than that: the parameters' u is {found.place_factor:.2g} "
            f"times what the scatter within the {found.places} places makes it"
        )
        return f"{text}; so few places say it roughly." if few else f"{text}."
    if few:
        return f"There are only {found.places} places to see it in: intervals are wide for it."
    return ""


def _freedom(value: float) -> str:
    shown = degrees_of_freedom(value)
    return f"{shown} degree{'s' * (not math.isclose(value, 1.0))} of freedom"
