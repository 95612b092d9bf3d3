"""Values as people write them on a command line: "length=443.172±0.001"."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from ulna.ground.errors import UlnaInputError

_SPLIT = re.compile(r"±|\+/-|\+-")


def values_said(texts: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Quantity → (value, standard uncertainty), mm. Raises UlnaInputError."""
    found: dict[str, tuple[float, float]] = {}
    for text in texts:
        quantity, equals, size = text.partition("=")
        quantity = quantity.strip()
        if not equals or not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9 _.-]*", quantity):
            raise UlnaInputError(
                f'option --value: got {text[:60]!r}, expected such as "length=443.172±0.001". Correct it.'
            )
        if quantity in found:
            raise UlnaInputError(f"option --value: '{quantity}' is given twice; expected once. Leave one out.")
        found[quantity] = _pair(size, "option --value")
    return found


def expansion_said(text: str | None) -> tuple[float | None, float | None]:
    """Coefficient and its standard uncertainty, 1/K. Raises UlnaInputError."""
    if text is None:
        return None, None
    alpha, u = _pair(text, "option --expansion")
    if not abs(alpha) < 1e-3:
        raise UlnaInputError(
            f"option --expansion: got {alpha:g} 1/K; expected such as 11.5e-6. Is it in ppm? Correct it."
        )
    return alpha, u


def _pair(text: str, what: str) -> tuple[float, float]:
    try:
        value, u = (float(each) for each in _SPLIT.split(text))
    except ValueError:
        value = u = math.nan
    if not (math.isfinite(value) and math.isfinite(u) and u >= 0):
        raise UlnaInputError(
            f"{what}: got {text[:60]!r}, expected a value and its standard uncertainty, such as 443.172±0.001 (or +-). "
            "Correct it."
        )
    return value, u
