"""Which feature a touch is of, and whether the artefact was moved: from where the tip is. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64
from ulna.live.touches import Touch, tips

NEAR_MM = 25.0
"""A tip this near to where a feature is expected is on it: an arm from a drawing errs by some millimetres."""


@dataclass(frozen=True)
class Told:
    """What a touch was taken for."""

    feature: int
    moved: bool
    """Whether the artefact stands elsewhere than at the touch before."""


def tell(arm: Arm, artefact: Artefact, own: list[Touch], tip_mm: F64, expected: int | None) -> Told:
    """own: the touches in the place where the artefact stood last; tip_mm: (3,) of the new one; expected: the feature
    that was suggested, None: none was."""
    first = 0 if expected is None else expected
    if kind_of(artefact).scattered or not artefact.features:
        return Told(0, False)
    if not own:
        return Told(first, False)
    off_mm = _off(arm, artefact, own, tip_mm)
    if expected is not None and off_mm[expected] < NEAR_MM and off_mm[expected] < 2.0 * off_mm.min() + 1.0:
        return Told(expected, False)
    best = int(off_mm.argmin())
    if off_mm[best] < NEAR_MM or not kind_of(artefact).placed(artefact):
        return Told(best, False)
    return Told(first, True)


def _off(arm: Arm, artefact: Artefact, own: list[Touch], tip_mm: F64) -> F64:
    """(K,) how far the tip is from each feature: from where that was touched, or by how much its distances to those
    that were touched are off."""
    stated_mm = np.array(list(artefact.features.values()), dtype=np.float64)
    at_mm, feature = tips(arm, own), np.array([touch.feature for touch in own])
    touched = np.unique(feature)
    known_mm = {int(k): at_mm[feature == k].mean(axis=0) for k in touched}
    off = np.zeros(len(stated_mm))
    for k in range(len(stated_mm)):
        if k in known_mm:
            off[k] = float(np.linalg.norm(tip_mm - known_mm[k]))
            continue
        apart = [
            abs(np.linalg.norm(tip_mm - place) - np.linalg.norm(stated_mm[k] - stated_mm[j]))
            for j, place in known_mm.items()
        ]
        off[k] = float(max(apart))
    return off
