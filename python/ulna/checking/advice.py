"""What to try where a figure is out, in the order of what it costs."""

from __future__ import annotations

from collections.abc import Mapping

#: kind of test → what to do again, and what to look at
TOUCH = {
    "single-point": "Touch the seat again, elbow and wrist moved between touches, the probe pressed lightly.",
    "articulation": "Touch the ball again in every orientation of the probe.",
    "sphere": "Touch the ball again, over half of it.",
    "effective-diameter": "Touch the ball again, over half of it.",
    "length": "Touch the length again in that place, both ends.",
    "volumetric": "Touch the bar again in those places, both ends.",
}
LOOK = {
    "single-point": "Look at the probe (tight, its ball clean and unworn) and at its seat (clean, does not give way).",
    "articulation": "Look at the probe: tight, straight, its ball clean and unworn; an offset shows here first.",
    "sphere": "Look at the probe's ball and at the ball of the check: clean, unworn, nothing loose.",
    "effective-diameter": "Look at the probe's ball, clean and unworn: is it the one that the arm file has?",
    "length": "Look at the bar: its seats clean, its supports as always, as warm as the protocol says.",
    "volumetric": "Look at the bars: their seats clean, their supports as always, as warm as the protocol says.",
}
WARM = "Let the arm warm up and turn every joint through its travel; then check again. Is its base fixed?"
RECALIBRATE = "Recalibrate (ulna calibrate), and ask ulna compare what has moved; until then do not rely on the arm."
SLOW = "Touching again will not help: it has changed over several checks."
NO_OTHER = "Check against an artefact of another kind: a bar for lengths, a seat for points."
BOTH = "Points and lengths are both out: more likely the arm, or its probe, than an artefact."
#: whether it is lengths that are out → what it means that points are not, or the other way round
ALONE = {
    False: "Lengths of the check are not out: more likely the probe, or what it touches, than the arm.",
    True: "Points of the check are not out: more likely the artefact, its supports or its temperature than the arm.",
}
_OF_LENGTHS = ("length", "volumetric")


def advice(kind: str, slow: bool, others: Mapping[str, bool]) -> list[str]:
    """kind: of the test that a figure is of; slow: whether only several checks together show it; others: kinds of the
    protocol's other tests, and whether one of their figures is out. Raises KeyError for a kind of which nothing is
    said here."""
    return [SLOW if slow else TOUCH[kind], LOOK[kind], WARM, _other(kind in _OF_LENGTHS, others), RECALIBRATE]


def _other(of_lengths: bool, others: Mapping[str, bool]) -> str:
    out = [each for kind, each in others.items() if (kind in _OF_LENGTHS) != of_lengths]
    if not out:
        return NO_OTHER
    return BOTH if any(out) else ALONE[of_lengths]
