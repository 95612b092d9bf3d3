"""Numbers as people read them, beside the numbers."""

from __future__ import annotations

import math

from ulna.ground.digits import rounded, uncertainty
from ulna.serve.contract.model import Value


def valued(value: float | None, unit: str, u: float | None = None, expanded: float | None = None) -> Value:
    """A value with its uncertainty. u: standard; expanded: U, k = 2 where it is not given."""
    if value is None or not math.isfinite(value):
        return Value(text="–", unit=unit, value=None)
    if u is not None and not math.isfinite(u):
        u = None
    if expanded is None and u is not None:
        expanded = 2.0 * u
    text, u_text = rounded(value, expanded, unit)
    return Value(text=text, u_text=None if expanded is None else u_text, unit=unit, value=value, u=u)


def uncertain(u: float | None, unit: str) -> Value:
    """A standard uncertainty by itself, two digits."""
    if u is None or not math.isfinite(u):
        return Value(text="–", unit=unit, value=None)
    return Value(text=uncertainty(u), unit=unit, value=u)


def length(mm: float | None) -> Value:
    """A small length in the unit in which people say it: 71 µm, 1.3 mm; the number is in mm."""
    from ulna.live.said import length_said

    if mm is None or not math.isfinite(mm):
        return Value(text="–", unit="mm", value=None)
    text, _, unit = length_said(mm).partition(" ")
    return Value(text=text, unit=unit, value=mm)
