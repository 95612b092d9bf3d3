"""Why a calibration gives no uncertainties, and what would help."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ulna.ground.worded import worded

LEAST_EACH = 2.5
"""Equations for each fitted parameter, placements taken off, from which on a loss tells outliers from readings that the
fit has not followed."""


@dataclass(frozen=True)
class Unknown:
    """Why there are none."""

    kind: Literal["freedom", "loss", "earlier"]
    """"freedom": nothing is left to estimate them from; "loss": a loss was fitted to too few readings; "earlier": of
    held parameters, which an earlier calibration left so."""
    loss: str = "none"
    each: float = 0.0
    """Equations for each fitted parameter, placements taken off."""

    @property
    def because(self) -> str:
        """As the end of a sentence."""
        return {
            "freedom": worded("the calibration had no degrees of freedom to estimate uncertainties from"),
            "loss": worded(
                "with loss '{loss}' the calibration had {each} equations for each parameter, and of fewer than {least} "
                "no loss can tell outliers from readings that the fit has not followed",
                loss=self.loss,
                each=f"{self.each:.1f}",
                least=f"{LEAST_EACH:g}",
            ),
            "earlier": worded("the calibration held parameters of an earlier one that gave no uncertainties"),
        }[self.kind]

    @property
    def remedy(self) -> str:
        """A sentence."""
        return {
            "freedom": worded("Calibrate with more readings, or state the noise in the study."),
            "loss": worded(
                "Calibrate with more readings, fit fewer parameters (fewer extras, more held), or look at the readings "
                "far off, leave out what is wrong, and set loss = 'none'."
            ),
            "earlier": worded("Repeat the earlier calibration with more readings, or with its noise stated."),
        }[self.kind]


def why_unknown(fit: Mapping[str, Any]) -> Unknown:
    """Of a calibration without uncertainties, from the table `fit` of its result."""
    freedom = _number(fit, "degrees_of_freedom")
    if freedom <= 0.0:
        return Unknown("freedom")
    loss = fit.get("loss", "none")
    if loss == "none":
        return Unknown("earlier")
    equations = _number(fit, "observations") - _number(fit, "placement_unknowns")
    return Unknown("loss", str(loss), equations / max(equations - freedom, 1e-9))


def _number(fit: Mapping[str, Any], key: str) -> float:
    value = fit.get(key)
    if not isinstance(value, int | float):
        return 0.0
    try:
        return float(value)
    except OverflowError:  # an integer of hundreds of digits, which no calibration counts
        return math.inf
