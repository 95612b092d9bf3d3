"""What a count says of a probability."""

from __future__ import annotations

import math

from ulna.ground.quantiles import normal


def wilson(inside: int, count: int, p: float = 0.95) -> tuple[float, float]:
    """Both ends of the interval that holds, with confidence p, the probability of what came `inside` times of
    `count`, 1 or more (Wilson 1927)."""
    z2 = normal(0.5 * (1.0 + p)) ** 2
    share = inside / count
    middle = (share + z2 / (2.0 * count)) / (1.0 + z2 / count)
    half = math.sqrt(z2 * (share * (1.0 - share) / count + z2 / (4.0 * count**2))) / (1.0 + z2 / count)
    return max(middle - half, 0.0), min(middle + half, 1.0)
