"""Which feature a touch is of, and whether the artefact was moved: from where the tip is. Lengths mm.

How near is near follows from how well the arm is known: of two postures on one seat an arm from a drawing says two
places, some millimetres apart, and one whose zeros were found by eye some centimetres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64, I64
from ulna.live.running import RunningFit
from ulna.live.touches import Touch, tips

NEAR_MM = 25.0
"""A tip this near to where a feature is expected is on it, whatever is known of the arm: a hand's breadth is a move."""
SURE = 4.0
"""Standard deviations."""


@dataclass(frozen=True)
class Tip:
    """A posture that is to be told."""

    q_rad: F64
    """(n,)"""
    probe: int


@dataclass(frozen=True)
class Expected:
    """What was suggested."""

    feature: int
    here: bool
    """Whether the artefact was to stay where it is."""


@dataclass(frozen=True)
class Told:
    """What a touch was taken for."""

    feature: int
    moved: bool
    """Whether the artefact stands elsewhere than at the touch before."""
    apart_mm: float = 0.0
    """Of a moved one: how far the tip is from where the feature was."""


def tell(fit: RunningFit, artefact: Artefact, own: Sequence[Touch], tip: Tip, expected: Expected | None) -> Told:
    """own: the touches in the place where the artefact stood last; expected: None where nothing was suggested.

    What was suggested is believed as long as what is known of the arm allows it: where it says that the tip is too far
    off, the nearest feature is taken, or the artefact was moved.
    """
    first = 0 if expected is None else expected.feature
    if kind_of(artefact).scattered or not artefact.features:
        return Told(0, False)
    if not own:
        return Told(first, False)
    off_mm = _off(fit.arm, artefact, own, tip)
    stays = expected is None or expected.here
    u_mm = _u_mm(fit, artefact, own, tip) if stays else np.zeros(len(off_mm))
    near = off_mm < np.maximum(NEAR_MM, SURE * u_mm)
    if expected is not None and near[first]:
        least = float(off_mm.min())
        if off_mm[first] - least < max(least + 1.0, SURE * float(u_mm[first])):
            return Told(first, False)
    best = int(off_mm.argmin())
    if near[best] or not kind_of(artefact).placed(artefact):
        return Told(best, False)
    return Told(first, True, float(off_mm[first]))


def _off(arm: Arm, artefact: Artefact, own: Sequence[Touch], tip: Tip) -> F64:
    """(K,) how far the tip is from each feature: from where that was touched, or by how much its distances to those
    that were touched are off."""
    stated_mm = np.array(list(artefact.features.values()), dtype=np.float64)
    tip_mm = arm.core.tip(np.ascontiguousarray(tip.q_rad[None]), tip.probe)[0]
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


def _u_mm(fit: RunningFit, artefact: Artefact, own: Sequence[Touch], tip: Tip) -> F64:
    """(K,) of these distances the standard deviation that the arm's parameters, as they are known, contribute: of the
    step from the touches of the feature, or from all where there are none of it."""
    free = fit.free()
    of_arm = free < len(fit.arm.parameter_names)
    covariance = fit.so_far().covariance[np.ix_(of_arm, of_arm)]
    rows = _rows(fit.arm, free[of_arm], [(tip.q_rad, tip.probe), *((each.q_rad, each.probe) for each in own)])
    feature = np.array([touch.feature for touch in own])
    found = np.zeros(len(artefact.features))
    for k in range(len(found)):
        these = feature == k if (feature == k).any() else np.ones(len(own), dtype=bool)
        step = rows[0] - rows[1:][these].mean(axis=0)
        found[k] = np.sqrt(max(float(np.einsum("ij,jk,ik->", step, covariance, step)), 0.0))
    return found


def _rows(arm: Arm, free: I64, poses: Sequence[tuple[F64, int]]) -> F64:
    """(N, 3, F)"""
    each = [arm.core.jacobian(np.ascontiguousarray(q_rad[None]), probe)[0][:, free] for q_rad, probe in poses]
    return np.array(each)
