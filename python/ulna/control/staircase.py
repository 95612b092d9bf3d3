"""Interval by steps: longer after a calibration that found all well inside the limits, shorter after one that found
something outside.

ILAC-G24:2022 / OIML D 10:2022, method 1, "automatic adjustment or staircase": well inside is 80 % of the limit there;
by how much an interval changes is for the laboratory to say.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from ulna.control.basis import Basis
from ulna.ground.errors import UlnaInputError

Step = Literal["longer", "kept", "shorter"]


@dataclass(frozen=True)
class Staircase:
    """Days."""

    basis: Basis
    """Figures of one calibration, as found; its span is the interval after which they were found."""
    step: Step | None
    """None where there are no figures to go by, and then no interval either."""
    interval_days: float | None
    shares: dict[str, float]
    """Of its limit that each figure takes, by name."""
    reason: str
    """In words, with the figure that decided."""


def staircase(
    found: Mapping[str, tuple[float, float]],
    interval_days: float,
    well_inside: float = 0.8,
    longer: float = 1.25,
    shorter: float = 0.5,
    bounds_days: tuple[float, float] = (30.0, 1826.0),
) -> Staircase:
    """found: name → (figure as found, its limit > 0, of the same unit); interval_days: after which it was found.

    longer, shorter: factors of the interval, above and below 1; bounds_days: no shorter and no longer than these.
    Raises UlnaInputError for what can be none of it.
    """
    least, most = bounds_days
    if not (interval_days > 0.0 and 0.0 < well_inside <= 1.0 and longer >= 1.0 >= shorter > 0.0 and least <= most):
        raise UlnaInputError(
            f"staircase: got {interval_days:g} days, longer by {longer:g}, shorter by {shorter:g}, well inside at "
            f"{well_inside:g}, from {least:g} to {most:g} days; expected days above 0, longer >= 1, 0 < shorter <= 1, "
            "0 < well inside <= 1. Correct them."
        )
    for name, (_, limit) in found.items():
        if not limit > 0.0:
            raise UlnaInputError(f"staircase: '{name}': got limit {limit:g}; expected one above 0. Correct it.")
    rests_on = Basis("staircase", len(found), 1, interval_days)
    if rests_on.too_few:
        return Staircase(rests_on, None, None, {}, "no figure was found, so that nothing is said.")
    shares = {name: abs(value) / limit for name, (value, limit) in found.items()}
    worst = max(shares, key=lambda name: shares[name])
    step, factor, why = _step(shares[worst], well_inside, longer, shorter)
    new = min(max(factor * interval_days, least), most)
    held = "" if new == factor * interval_days else f", held to the bounds {least:g} to {most:g} days"
    reason = f"'{worst}' was found at {100.0 * shares[worst]:.0f} % of its limit after {interval_days:g} days: {why}"
    return Staircase(rests_on, step, new, shares, f"{reason}; next {new:g} days{held}.")


def _step(share: float, well_inside: float, longer: float, shorter: float) -> tuple[Step, float, str]:
    if share > 1.0:
        return "shorter", shorter, f"outside, so the interval is multiplied by {shorter:g}"
    if share <= well_inside:
        return (
            "longer",
            longer,
            f"all within {100.0 * well_inside:g} %, so the interval is multiplied by {longer:g}",
        )
    return "kept", 1.0, f"inside, but not within {100.0 * well_inside:g} %, so the interval is kept"
