"""Sensible digits: as many as the uncertainty bears, never more than the unit makes sense of."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Context, Decimal

_MOST_DECIMALS = {"mm": 6, "rad": 9, "1": 9}
_PLAIN_DECIMALS = {"mm": 4, "rad": 6, "1": 6}
"""Where no uncertainty is known: 0.1 µm, 1 µrad, a millionth."""


def decimals(u: float | None, unit: str) -> int:
    """Decimals that show two digits of a standard uncertainty `u`."""
    if u is None or not u > 0.0:
        return _PLAIN_DECIMALS[unit]
    return min(max(1 - _power(u), 0), _MOST_DECIMALS[unit])


def quantity(value: float, u: float | None, unit: str) -> str:
    """A parameter's value with the digits that its uncertainty bears; 1/K and rad/(N m), all tiny, in powers of ten."""
    if unit in _MOST_DECIMALS:
        return fixed(value, decimals(u, unit))
    if value == 0.0:
        return "0"
    bears = 3 if not u else _power(value) - _power(u) + 2
    return small(value, min(max(bears, 1), 6))


def fixed(value: float, places: int) -> str:
    """A value with that many decimals; no minus before a zero."""
    text = f"{value:.{places}f}"
    return text.removeprefix("-") if float(text) == 0.0 else text


def uncertainty(u: float | None) -> str:
    """Two digits: 0.0031, 3.1e-6; a dash where it is not known."""
    if u is None:
        return "–"
    if u == 0.0:
        return "0"
    return small(u, 2) if u < 1e-4 else fixed(u, max(1 - _power(u), 0))


def plain_uncertainty(u: float | None, unit: str) -> str:
    """The same of lengths, angles and numbers as plain decimals, as the values beside them are: 0.0000031."""
    if u is None or unit not in _MOST_DECIMALS or not u >= 10.0 ** -_MOST_DECIMALS[unit]:
        return uncertainty(u)
    return fixed(u, decimals(u, unit))


def two_digits_up(value: float) -> float:
    """The least number of two significant digits that is not below a value > 0 (or 0); 0.00231 is 0.0024. What lies
    beyond the twelfth digit is taken for the rounding of a sum."""
    exact = Decimal(f"{value:.12g}")
    return 0.0 if exact == 0 else float(exact.quantize(Decimal(1).scaleb(exact.adjusted() - 1), ROUND_CEILING))


def _power(value: float) -> int:
    """Of ten, of the first digit when two are shown: 0.0996 is 0.10."""
    return int(f"{value:.1e}".split("e")[1])


def figure_mm(value: float) -> str:
    """A figure in mm to 0.1 µm; what is smaller than that in powers of ten."""
    return small(value, 2) if 0.0 < abs(value) < 5e-5 else fixed(value, 4)


def percent(share: float) -> str:
    """A probability in percent, with two digits of what it lacks to 0 or to 100; at most a millionth is not told."""
    tail = min(share, 1.0 - share)
    if tail < 1e-6:
        return "< 0.0001" if share < 0.5 else "> 99.9999"
    return fixed(100.0 * share, max(1 - _power(100.0 * tail), 0))


def degrees_of_freedom(value: float) -> str:
    """A number that need not be whole: 76, 44.3; below one with two digits."""
    return f"{value:.2g}" if value < 1.0 else f"{value:.1f}".removesuffix(".0")


def small(value: float, digits: int) -> str:
    """3.1e-6, without the zero that printf puts into exponents."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def rounded(value: float, expanded: float | None, unit: str) -> tuple[str, str]:
    """A value and its expanded uncertainty for a certificate: U with two significant digits, the value to the same
    place (GUM 7.2.6), both to the nearest, halves to even; without U as `quantity` has it, and a dash.

    Lengths and angles are plain decimals; 1/K and rad/(N m), and what is smaller than 1e-12, are in powers of ten.
    Where U is 0 the value is as it was given.
    """
    if expanded is None or not math.isfinite(expanded):
        return quantity(value, None, unit), "–"
    if expanded == 0.0:
        return f"{value:.12g}", "0"
    exact = Decimal(repr(value))
    shown = Decimal(f"{expanded:.1e}")  # to two digits first: 0.0996 is 0.10, and its last place is the hundredth
    place = shown.adjusted() - 1
    nearest = exact.quantize(Decimal(1).scaleb(place), ROUND_HALF_EVEN, Context(prec=60))
    if unit in _MOST_DECIMALS and place >= -12:
        text = f"{nearest:f}"
        return (text.removeprefix("-") if nearest == 0 else text), f"{shown:f}"
    if nearest == 0:
        return "0", small(expanded, 2)
    return small(float(nearest), max(nearest.adjusted() - place, 0) + 1), small(expanded, 2)
