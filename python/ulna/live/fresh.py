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
from ulna.live.touches import Touch, present, tips

USUAL = 10
"""Fresh places that are asked for where nobody says how many."""
ALONE = 4
"""Touches that a fresh place of a single feature is judged by: its scatter is all that there is."""
DRAWN, APART_MM = 100, 60.0
"""Candidates of which a fresh place is one, and how far it is from what was touched, so that a move is seen."""
SEED = 89
"""Of all that is drawn here, beside the plan's and the number of the place."""
STANDS_MM = 2.0
"""So near to an earlier touch a first touch in a fresh place says that nothing was moved."""


@dataclass(frozen=True)
class Fresh:
    """How far it is."""

    places: int
    """That were asked for."""
    done: int
    """Touched so that they judge."""


def done(guide: Guide, touches: Sequence[Touch]) -> int:
    """Fresh places, of touches that are held out; touches where the artefact stands where it is known to."""
    if not kind_of(guide.spec.artefact).placed(guide.spec.artefact):
        return len(touches)
    standings = list(dict.fromkeys(touch.standing for touch in touches))
    return sum(judges(guide, [each for each in touches if each.standing == one]) for one in standings)


def judges(guide: Guide, own: Sequence[Touch]) -> bool:
    """Whether the touches in one place are enough to judge by."""
    kind, artefact = kind_of(guide.spec.artefact), guide.spec.artefact
    if not kind.placed(artefact):
        return len(own) > 0
    if kind.scattered:
        return len(own) >= guide.per_place
    return not guide.at_hand.untouched(own) and len(own) >= (ALONE if len(artefact.features) == 1 else 1)


def next_fresh(guide: Guide, place: int, own: Sequence[Touch]) -> Suggestion:
    """Where it stands as long as that place does not judge, then in another. own: touches held out in `place`."""
    if not kind_of(guide.spec.artefact).placed(guide.spec.artefact) or not judges(guide, own):
        return _touch_in(guide, place, own)
    return _touch_in(guide, place + 1, [])


def _touch_in(guide: Guide, place: int, own: Sequence[Touch]) -> Suggestion:
    """A touch to judge by: its place is any that is no earlier one, not the best. It follows from the number of the
    place, and is the same after an interruption. own: the touches there already."""
    rng = np.random.default_rng([guide.spec.seed, SEED, place, len(own)])
    kind, artefact = kind_of(guide.spec.artefact), guide.spec.artefact
    number = _elsewhere(guide, place)
    if kind.placed(artefact):
        untouched = [len(own)] if kind.scattered else guide.at_hand.untouched(own)
        if untouched:
            return guide.in_new_place(number, untouched[0], 0.0, bool(own))
    points_mm, q_rad, feature = guide.at_hand.postures(own) if kind.placed(artefact) else guide.at_hand.fixed()
    if not len(q_rad):
        return guide.in_new_place(number, 0, 0.0, bool(own))
    k = int(rng.integers(len(q_rad)))
    return guide.suggestion(int(feature[k]), q_rad[k], points_mm, True, 0.0)


def _elsewhere(guide: Guide, place: int) -> int:
    """Of some candidates at random the first that stands apart from all that was touched, else the one farthest."""
    rng, candidates = np.random.default_rng([guide.spec.seed, SEED, place, 0]), guide.candidates
    some = rng.permutation(len(candidates))[:DRAWN]
    name = guide.spec.artefact.name
    earlier = {
        (touch.standing, touch.feature): touch
        for touch in present(guide.fit.touches)
        if touch.artefact == name and touch.standing != str(place)
    }
    if not earlier:
        return int(some[0])
    at_mm, touched_mm = candidates.features_mm[candidates.place[some]], tips(guide.fit.arm, list(earlier.values()))
    between = np.linalg.norm(at_mm[:, :, None] - touched_mm, axis=-1).min(axis=(1, 2))
    apart = np.flatnonzero(between > APART_MM)
    return int(some[apart[0] if len(apart) else between.argmax()])


def stands_still(artefact: Artefact, earlier_mm: F64, tip_mm: F64) -> bool:
    """Whether the first touch of a place is where one was before. earlier_mm: (N, 3) tips in other places."""
    kind = kind_of(artefact)
    if kind.scattered or not kind.placed(artefact) or not len(earlier_mm):
        return False
    return bool(np.linalg.norm(earlier_mm - tip_mm, axis=1).min() < STANDS_MM)
