"""What to try where a figure is out, in the order of what it costs."""

from __future__ import annotations

from collections.abc import Mapping

from ulna.ground.worded import worded
from ulna.verification.kinds.registry import KINDS, LENGTHS, kind_of

WARM = worded("Let the arm warm up and turn every joint through its travel; then check again. Is its base fixed?")
RECALIBRATE = worded(
    "Recalibrate (ulna calibrate), and ask ulna compare what has moved; until then do not rely on the arm."
)
SLOW = worded("Touching again will not help: it has changed over several checks.")
NO_OTHER = worded("Check against an artefact of another kind: a bar for lengths, a seat for points.")
BOTH = worded("Points and lengths are both out: more likely the arm, or its probe, than an artefact.")
#: whether it is lengths that are out → what it means that points are not, or the other way round
ALONE = {
    False: worded("Lengths of the check are not out: more likely the probe, or what it touches, than the arm."),
    True: worded(
        "Points of the check are not out: more likely the artefact, its supports or its temperature than the arm."
    ),
}


def steps() -> list[str]:
    """All that may be advised."""
    looked = [said for kind in KINDS.values() for said in (kind.again, kind.look)]
    return [WARM, RECALIBRATE, SLOW, NO_OTHER, BOTH, *ALONE.values(), *looked]


def advice(kind: str, slow: bool, others: Mapping[str, bool]) -> list[str]:
    """kind: of the test that a figure is of; slow: whether only several checks together show it; others: kinds of the
    protocol's other tests, and whether one of their figures is out."""
    own = kind_of(kind)
    return [SLOW if slow else own.again, own.look, WARM, _other(own.length_errors, others), RECALIBRATE]


def _other(of_lengths: bool, others: Mapping[str, bool]) -> str:
    out = [each for kind, each in others.items() if (kind in LENGTHS) != of_lengths]
    if not out:
        return NO_OTHER
    return BOTH if any(out) else ALONE[of_lengths]
