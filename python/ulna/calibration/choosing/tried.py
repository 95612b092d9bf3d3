"""What a search for a model tried, as results have it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

Ended = Literal["all-tried", "budget", "too-few"]
"""Everything was tried; the budget ended the search before the models in `untried`; there were too few readings to
leave some out, so that nothing was tried."""


@dataclass(frozen=True)
class TriedModel:
    """One model, and how it did on readings that its fit had not seen."""

    extras: list[str]
    """Its blocks beyond geometry; none: geometry alone."""
    order: int | None
    """Highest order of its harmonics; None without."""
    parameters: int
    """How many parameters its blocks add."""
    prior_u_rad: float | None
    """Standard deviation of an amplitude of order 1 before any reading, as the readings show it, or 5e-4 rad."""
    fall: float | None
    """c of the law by which it falls with the order k, √(1/k² + c²) of that of order 1; None: it does not, or the
    study states it."""
    error_mm: float
    """Its figure on the readings left out, mean over the groups."""
    u_mm: float | None
    """Standard error of that mean."""
    worse_by_mm: float
    """Than the model with the smallest error."""
    u_worse_by_mm: float | None
    """Standard error of that difference, from the groups."""
    kept: bool
    seconds: float
    """What trying it took."""


@dataclass(frozen=True)
class ChosenModel:
    """Which model was chosen, and by what."""

    extras: list[str]
    harmonics: list[int]
    """Orders."""
    ended: Ended
    by: str
    """What was left out together: "placements", "regions of placements" or "regions of readings"."""
    groups: int
    """How many of them."""
    figure: str
    """Which figure the models were compared by; "" where nothing was tried."""
    seconds: float
    drawn_length_mm: float | None = None
    """Where blocks were chosen: standard deviation of lengths about the arm file before any reading."""
    drawn_angle_rad: float | None = None
    """The same of angles."""
    tried: list[TriedModel] = field(default_factory=list)
    """In the order of their parameters."""
    untried: int = 0
    """Models that the budget left no room for."""
    impossible: dict[str, str] = field(default_factory=dict)
    """Block → why the study does not allow it."""
