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
    """Its blocks beyond geometry."""
    order: int | None
    """Highest order of its harmonics; None without."""
    drawn: bool
    """Whether it knows how well arms keep to drawings; false of plain least squares."""
    parameters: int
    """How many parameters its blocks add."""
    lengths_u_mm: float | None
    """Standard deviation of links' lengths about the drawing before any reading; None: not known, or as stated."""
    prior_u: dict[str, float]
    """Block → standard deviation of its parameters before any reading, as the readings show it, in their unit; of
    harmonics that of an amplitude of order 1. Without what the study states."""
    fall: float | None
    """c of the law by which that of harmonics falls with the order k, √(1/k² + c²); None: it does not."""
    error_mm: float
    """Its figure on the readings left out, geometric mean over the groups."""
    worse_by: float
    """By what part of the error of the model with the smallest one: 0.03 is 3 %."""
    u_worse_by: float
    """Standard error of that, from the groups."""
    kept: bool
    seconds: float
    """What trying it took."""


@dataclass(frozen=True)
class ChosenModel:
    """Which model was chosen, and by what."""

    extras: list[str]
    harmonics: list[int]
    """Orders."""
    drawn: bool
    """Whether what is known of an arm from its drawing is part of it."""
    ended: Ended
    by: str
    """What was left out together: "placements", "regions of placements" or "regions of readings"."""
    groups: int
    """How many of them."""
    figure: str
    """Which figure the models were compared by; "" where nothing was tried."""
    seconds: float
    drawn_u: dict[str, float] = field(default_factory=dict)
    """Pattern of parameters → standard deviation about the arm file before any reading, mm or rad; none: plain."""
    tried: list[TriedModel] = field(default_factory=list)
    """In the order of their parameters."""
    untried: int = 0
    """Models that the budget left no room for."""
    impossible: dict[str, str] = field(default_factory=dict)
    """Block → why the study does not allow it."""
