"""How long until the prediction of a figure meets its limit: the interval that ILAC-G24:2022, method 2 (control chart),
asks to be taken from drift and spread."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ulna.control.basis import Basis
from ulna.control.drift import Drift, Line
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded


@dataclass(frozen=True)
class Until:
    """Days from the last figure."""

    basis: Basis
    lower: float
    upper: float
    """The limits less the guard band, which the prediction may not pass."""
    meets_days: float | None
    """When the band meets one of them, however far that is; None where there are too few figures, or it never does."""
    interval_days: float | None
    """The same, no longer than `longest_days`; None where there are too few figures."""
    reason: str
    """In words."""


def until(
    found: Drift, upper: float, lower: float | None = None, guard: float = 0.0, longest_days: float | None = None
) -> Until:
    """When the band of `found` meets a limit less its guard band.

    upper, lower: limits, in the unit of the figures; lower None: -upper, of figures that may have either sign; -inf
    where there is none. guard: ≥ 0. longest_days: of what is advised; None: the span of the history, for a line is not
    believed farther beyond its figures than they reach. Raises UlnaInputError for limits that leave nothing between.
    """
    low, high = (-upper if lower is None else lower) + guard, upper - guard
    if not (guard >= 0.0 and low < high):
        raise UlnaInputError(
            f"limits: got {low - guard:g} to {high + guard:g} with a guard band of {guard:g}, which leaves nothing "
            "between; expected a guard band smaller than that. Correct them."
        )
    if found.line is None:
        return Until(
            found.basis, low, high, None, None, worded("{basis}; no interval is advised.", basis=found.basis.said)
        )
    line = found.line
    first = line.last_days
    low_now, high_now = found.band(first) or (-math.inf, math.inf)
    if low_now < low or high_now > high:
        why = worded("the prediction is beyond the limit on the last day already.")
        return Until(found.basis, low, high, 0.0, 0.0, why)
    over = _meets(found, line, line.slope, high - line.middle)
    under = _meets(found, line, -line.slope, line.middle - low)
    days = min(over, under) - first
    most = found.basis.span_days if longest_days is None else longest_days
    assert most is not None
    if days <= most:
        said = {"sure": f"{found.confidence:.0%}", "days": f"{days:.0f}"}
        why = (
            worded("the {sure} prediction meets the upper limit, less its guard band, in {days} days.", **said)
            if over <= under
            else worded("the {sure} prediction meets the lower limit, less its guard band, in {days} days.", **said)
        )
        return Until(found.basis, low, high, days, days, why)
    longest = f"{most:.0f}"
    if math.isfinite(days):
        why = worded(
            "the prediction meets the limit after {days} days; no more than {most} days are advised.",
            days=f"{days:.0f}",
            most=longest,
        )
    else:
        why = worded("the prediction meets the limit never; no more than {most} days are advised.", most=longest)
    return Until(found.basis, low, high, days if math.isfinite(days) else None, most, why)


def _meets(found: Drift, line: Line, slope: float, room: float) -> float:
    """The first day after the last figure on which slope · x + k √(A + B x²) is `room`, x from the middle; inf: none.

    Squared it is (slope² - k² B) x² - 2 slope room x + room² - k² A = 0, of which the roots beyond the limit drop out.
    """
    if math.isinf(room):
        return math.inf
    k2 = found.k**2 * found.scale2
    a = slope**2 - k2 / line.spread_days2
    b = -2.0 * slope * room
    c = room**2 - k2 * (line.u_next**2 + 1.0 / line.total_weight)
    days = [line.middle_days + x for x in _roots(a, b, c) if room - slope * x >= 0.0]
    return min((day for day in days if day >= line.last_days), default=math.inf)


def _roots(a: float, b: float, c: float) -> list[float]:
    if a == 0.0:
        return [-c / b] if b != 0.0 else []
    square = b * b - 4.0 * a * c
    if square < 0.0:
        return []
    half = -0.5 * (b + math.copysign(math.sqrt(square), b))
    return [half / a, *([c / half] if half != 0.0 else [])]
