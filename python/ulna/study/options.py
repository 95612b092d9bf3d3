"""Options of a fit, checked: those from Python have the same limits as those from files."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, TypeVar, get_args

from ulna.arm.effects.effects import EXTRAS
from ulna.ground.errors import UlnaInputError, nearest
from ulna.study.data import AUTO, FitOptions, Loss, Method, StudyData

#: of whole numbers: lowest and highest
LIMITS = {"seed": (0, 2**63 - 1), "max_iterations": (0, 1_000_000), "budget": (100, 1_000_000_000)}


AnyStudy = TypeVar("AnyStudy", bound=StudyData)


def with_options(study: AnyStudy, **overrides: Any) -> AnyStudy:
    """The study with some fields of its `fit` replaced. Raises UlnaInputError for a name or a value that is none."""
    known = [field.name for field in dataclasses.fields(FitOptions)]
    for name in overrides:
        if name not in known:
            raise UlnaInputError(f"calibrate: there is no fit option '{name}'.{nearest(name, known)}")
    if "extras" in overrides:
        overrides.setdefault("auto", overrides["extras"] == AUTO)
    study = dataclasses.replace(study, fit=dataclasses.replace(study.fit, **overrides))
    fit = study.fit
    _check_auto(study)
    for name, (least, most) in LIMITS.items():
        number = getattr(fit, name)
        if not least <= number <= most:
            raise UlnaInputError(
                f"{study.label}: key 'fit.{name}': {number}; expected a whole number, {least} to {most}."
            )
    for name, given, choices in (
        ("start", fit.start, ("given", "search")),
        ("loss", fit.loss, get_args(Loss)),
        ("method", fit.method, get_args(Method)),
        *(("extras", extra, (*EXTRAS, AUTO)) for extra in fit.extras),
    ):
        if given not in choices:
            raise UlnaInputError(
                f"{study.label}: key 'fit.{name}': {given!r}; expected {_or(choices)}.{nearest(str(given), choices)}"
            )
    if AUTO in fit.extras:
        raise UlnaInputError(
            f"{study.label}: key 'fit.extras': {fit.extras}; 'auto' chooses among all of them, so it stands alone; "
            'expected extras = "auto". Remove the brackets, or name the extras.'
        )
    for pattern, prior in fit.prior.items():
        if not (math.isfinite(prior.u) and prior.u > 0.0):
            raise UlnaInputError(
                f"{study.label}: key 'fit.prior': {pattern!r} has the standard deviation {prior.u}; expected a "
                "positive number."
            )
    above = fit.poor_above_mm
    if above is not None and not (math.isfinite(above) and above > 0.0):
        raise UlnaInputError(f"{study.label}: key 'fit.poor_above_mm': {above}; expected a positive number of mm.")
    orders = fit.harmonics
    if not orders or sorted(set(orders)) != list(orders) or not 1 <= orders[0] <= orders[-1] <= 100:
        raise UlnaInputError(
            f"{study.label}: key 'fit.harmonics': {orders}; expected orders from 1 to 100, ascending, such as [1, 2]."
        )
    return study


def _check_auto(study: StudyData) -> None:
    """Raises UlnaInputError for what cannot be combined with blocks that are chosen."""
    if not study.fit.auto:
        return
    if study.fit.method != "lm":
        raise UlnaInputError(
            f"{study.label}: key 'fit.extras': 'auto' compares models by their derivatives, but key 'fit.method' asks "
            f"for a search without, '{study.fit.method}'; expected method \"lm\" beside it. Remove one of the two, or "
            "name the extras."
        )


def _or(choices: Any) -> str:
    *most, last = [repr(choice) for choice in choices]
    return f"{', '.join(most)} or {last}"
