"""What a certificate says of an arm whose calibration is not at hand. Units are mm and rad, always."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ulna.ground.arrays import F64

Figure = Literal["largest", "two_s", "two_sigma", "half_range", "form", "size"]


@dataclass(frozen=True)
class PointTest:
    """A seat touched in many postures (single-point articulation), at several distances."""

    figures_mm: dict[Figure, float]
    """As certified: largest, two_s, half_range."""
    positions: tuple[float, ...] = (0.2, 0.5, 0.8)
    """Distances from the base in parts of the reach."""
    touches: int = 10


@dataclass(frozen=True)
class LengthTest:
    """Known lengths in many places."""

    figures_mm: dict[Figure, float]
    """As certified: largest, two_sigma, half_range."""
    lengths_mm: tuple[float, ...]
    places: int = 20
    """Of each length."""


@dataclass(frozen=True)
class SphereTest:
    """A calibrated ball touched over one half of it."""

    figures_mm: dict[Figure, float]
    """As certified: form, size."""
    diameter_mm: float
    positions: int = 2
    touches: int = 25


Test = PointTest | LengthTest | SphereTest


@dataclass(frozen=True)
class Performance:
    """A certificate's figures, and what is assumed of the arm before they are looked at."""

    label: str
    """How messages call it."""
    probe: str
    spread_rad: float
    """Standard deviation of angles before, up to the common factor."""
    spread_mm: float
    """Of lengths and of the tip."""
    factor: tuple[float, float]
    """The common factor is uniform in its logarithm between these."""
    hold: tuple[str, ...]
    """Parameters that are as drawn: shell-style patterns."""
    encoder_rad: F64
    """(n,) standard deviation of each encoder."""
    seat_mm: float
    """Of a touch, per coordinate."""
    tests: tuple[Test, ...]
    within: float = 0.2
    """A simulated figure agrees that differs by no more than this part from the certificate's."""
    at_most: bool = False
    """A simulated figure agrees that is no larger than the certificate's."""
