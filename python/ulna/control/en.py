"""E_n, of two results of one thing: ISO/IEC 17043:2023, B.3.1.3, and ISO 13528:2022, 9.7."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class En:
    """Of 1 or less: their uncertainties explain the difference."""

    value: float
    difference: float
    """The first less the second."""
    expanded: float
    """U of that difference, in its unit."""
    method: str = "E_n"
    n: int = 2
    """Results."""

    @property
    def satisfactory(self) -> bool:
        """Whether |E_n| <= 1."""
        return self.value <= 1.0


def en(x1: float, expanded1: float, x2: float, expanded2: float, correlation: float = 0.0) -> En:
    """|x1 - x2| / √(U1² + U2² - 2 r U1 U2), U for the same coverage (k = 2, 95 %).

    correlation: r of the two, -1 to 1, where both rest on one standard; the standards have 0. Raises UlnaInputError
    for uncertainties that are none, or that leave the difference without one.
    """
    numbers = (x1, x2, expanded1, expanded2, correlation)
    if not all(map(math.isfinite, numbers)) or min(expanded1, expanded2) < 0.0 or abs(correlation) > 1.0:
        raise UlnaInputError(
            f"E_n: got {x1:g} with U {expanded1:g}, {x2:g} with U {expanded2:g}, correlation {correlation:g}; expected "
            "finite numbers, U of 0 or more, a correlation from -1 to 1. Correct them."
        )
    variance = expanded1**2 + expanded2**2 - 2.0 * correlation * expanded1 * expanded2
    if variance <= 0.0:
        raise UlnaInputError("E_n: the difference has no uncertainty; expected U above 0 of one of them. State it.")
    return En(abs(x1 - x2) / math.sqrt(variance), x1 - x2, math.sqrt(variance))
