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
from ulna.ground.worded import worded

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
        return Staircase(rests_on, None, None, {}, worded("no figure was found, so that nothing is said."))
    shares = {name: abs(value) / limit for name, (value, limit) in found.items()}
    worst = max(shares, key=lambda name: shares[name])
    step, factor, why = _step(shares[worst], well_inside, longer, shorter)
    new = min(max(factor * interval_days, least), most)
    reason = worded(
        "'{figure}' was found at {share} % of its limit after {days} days: {why}; next {new} days{held}.",
        figure=worst,
        share=f"{100.0 * shares[worst]:.0f}",
        days=f"{interval_days:g}",
        why=why,
        new=f"{new:g}",
        held=""
        if new == factor * interval_days
        else worded(", held to the bounds {least} to {most} days", least=f"{least:g}", most=f"{most:g}"),
    )
    return Staircase(rests_on, step, new, shares, reason)


def _step(share: float, well_inside: float, longer: float, shorter: float) -> tuple[Step, float, str]:
    if share > 1.0:
        return "shorter", shorter, worded("outside, so the interval is multiplied by {factor}", factor=f"{shorter:g}")
    if share <= well_inside:
        return (
            "longer",
            longer,
            worded(
                "all within {share} %, so the interval is multiplied by {factor}",
                share=f"{100.0 * well_inside:g}",
                factor=f"{longer:g}",
            ),
        )
    kept = worded("inside, but not within {share} %, so the interval is kept", share=f"{100.0 * well_inside:g}")
    return "kept", 1.0, kept
