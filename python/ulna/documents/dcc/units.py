r"""Units as D-SI writes them: `mm` is `\milli\metre`, and a covariance of mm and rad has `\milli\metre\radian`."""

from __future__ import annotations

_FACTORS: dict[str, dict[str, int]] = {
    "mm": {r"\milli\metre": 1},
    "rad": {r"\radian": 1},
    "1/K": {r"\kelvin": -1},
    "rad/(N m)": {r"\radian": 1, r"\newton": -1, r"\metre": -1},
    "°C": {r"\degreecelsius": 1},
    "K": {r"\kelvin": 1},
    "kg": {r"\kilogram": 1},
    "1": {},
}
_ORDER = (r"\milli\metre", r"\radian", r"\kelvin", r"\newton", r"\metre", r"\degreecelsius", r"\kilogram")


def dsi_unit(unit: str) -> str:
    r"""`mm`, `rad`, `1/K`, `rad/(N m)`, `°C`, `K`, `kg` or `1` as D-SI has it: prefix, unit, exponent."""
    return _written(_FACTORS[unit])


def dsi_product(first: str, second: str) -> str:
    r"""The unit of a product, whichever comes first: `mm` and `mm` → `\milli\metre\tothe{2}`, that is mm²."""
    exponents = dict(_FACTORS[first])
    for factor, exponent in _FACTORS[second].items():
        exponents[factor] = exponents.get(factor, 0) + exponent
    return _written(exponents)


def _written(exponents: dict[str, int]) -> str:
    parts = []
    for factor in sorted(exponents, key=_ORDER.index):
        exponent = exponents[factor]
        if exponent:
            parts.append(factor if exponent == 1 else f"{factor}\\tothe{{{exponent}}}")
    return "".join(parts) or r"\one"
