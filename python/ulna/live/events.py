"""What a session says: what happened with what came, and what is known after it. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

from ulna.live.faults import Fault
from ulna.live.fresh import Fresh
from ulna.live.guide import Suggestion
from ulna.live.lacking import Lacking
from ulna.live.running import SoFar
from ulna.live.touches import Touch
from ulna.live.trigger import Refused
from ulna.live.worth import Worth


@dataclass(frozen=True)
class Meter:
    """What is known after a touch."""

    so_far: SoFar
    determinable: int
    """Combinations of parameters that touches of this artefact can determine."""
    worth: Worth
    goal_u_mm: float | None
    touches_more: int | None
    """About how many to the goal."""
    next: Suggestion
    lacking: Lacking
    """What is lost, and what is weak."""
    fresh: Fresh | None = None
    """Of the places that are held out; None as long as touches are fitted."""


@dataclass(frozen=True)
class Happened:
    """A touch that was taken."""

    touch: Touch
    moved: bool
    """Whether the artefact was taken for moved."""
    scatter_mm: float | None
    """Standard deviation of the touches of this feature in this place about their mean; None for one alone, and as long
    as the arm follows whatever is touched."""
    off_mm: float | None
    """What the fit leaves of it; None before there is a fit."""
    times: float | None
    """The same in units of the scatter of all."""
    apart_mm: float = 0.0
    """Of a moved artefact: how far the tip is from where it was, by the arm as it was known."""
    against: int = 0
    """How often in a row it was taken for moved though it was to stay."""


Event = Fault | Refused | Happened
