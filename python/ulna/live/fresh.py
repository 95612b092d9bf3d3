"""Fresh places at the end of a session: touches that are not fitted, and judge what was.

A place where a touch was fitted judges nothing: what is held out begins where nothing stood yet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64
from ulna.live.guide import Guide, Suggestion
from ulna.live.touches import Touch

USUAL = 10
"""Fresh places that are asked for where nobody says how many."""
STANDS_MM = 2.0
"""So near to an earlier touch a first touch in a fresh place says that nothing was moved."""


@dataclass(frozen=True)
class Fresh:
    """How far it is."""

    places: int
    """That were asked for."""
    done: int
    """Touched so that they judge."""


def done(guide: Guide, artefact: Artefact, touches: Sequence[Touch]) -> int:
    """Fresh places, of touches that are held out; touches where the artefact stands where it is known to."""
    if not kind_of(artefact).placed(artefact):
        return len(touches)
    standings = list(dict.fromkeys(touch.standing for touch in touches))
    return sum(guide.judges([each for each in touches if each.standing == one]) for one in standings)


def next_fresh(guide: Guide, artefact: Artefact, place: int, own: Sequence[Touch]) -> Suggestion:
    """Where it stands as long as that place does not judge, then in another. own: touches held out in `place`."""
    if not kind_of(artefact).placed(artefact) or not guide.judges(own):
        return guide.fresh(place, own)
    return guide.fresh(place + 1, [])


def stands_still(artefact: Artefact, earlier_mm: F64, tip_mm: F64) -> bool:
    """Whether the first touch of a place is where one was before. earlier_mm: (N, 3) tips in other places."""
    kind = kind_of(artefact)
    if kind.scattered or not kind.placed(artefact) or not len(earlier_mm):
        return False
    return bool(np.linalg.norm(earlier_mm - tip_mm, axis=1).min() < STANDS_MM)
