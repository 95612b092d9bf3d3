"""Postures of the arm on the features of an artefact where it stands. mm and rad, base frame."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ulna.artefacts.artefact import features_mm
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64, I64
from ulna.live.running import RunningFit
from ulna.live.touches import Touch, tips
from ulna.planning.spec import PlanSpec
from ulna.planning.touchable import touchable
from ulna.simulation.mover import Mover
from ulna.simulation.places import postures_on

HERE = 200
"""Postures tried in a place."""

Found = tuple[F64, F64, I64]
"""(K, 3) where the features are, (N, n) postures on them, and (N,) which feature each is on."""


class AtHand:
    """Found once in each place: it takes longer than all else that a suggestion takes."""

    def __init__(self, fit: RunningFit, spec: PlanSpec, mover: Mover, rng: np.random.Generator) -> None:
        self._fit, self._spec, self._mover, self._rng = fit, spec, mover, rng
        self._probe = fit.arm.probe_index(spec.probe)
        self._known: tuple[str, Found] | None = None

    def fixed(self) -> Found:
        """On features whose places are stated in the arm's frame."""
        if self._known is None:
            self._known = "", self._found(features_mm(self._spec.artefact))
        return self._known[1]

    def postures(self, own: Sequence[Touch]) -> Found:
        """On the features where the touches in one place have found them; none where one was not touched yet, or
        touches are spread over the artefact."""
        place = own[0].standing
        if kind_of(self._spec.artefact).scattered or self.untouched(own):
            return np.zeros((0, 3)), np.zeros((0, self._fit.arm.n)), np.zeros(0, np.int64)
        if self._known is None or self._known[0] != place:
            at_mm, feature = tips(self._fit.arm, own), np.array([touch.feature for touch in own])
            places = [at_mm[feature == k].mean(axis=0) for k in range(len(self._spec.artefact.features))]
            self._known = place, self._found(np.array(places))
        return self._known[1]

    def untouched(self, own: Sequence[Touch]) -> list[int]:
        """Features that none of the touches is of."""
        touched = {touch.feature for touch in own}
        return [k for k in range(len(self._spec.artefact.features)) if k not in touched]

    def _found(self, points_mm: F64) -> Found:
        count = len(points_mm)
        each = max(1, HERE // count)
        standing = touchable(self._spec, self._fit.arm, self._probe).standing(self._spec, self._fit.arm)
        points = np.repeat(points_mm, each, axis=0)
        seed = int(self._rng.integers(2**63))
        q_rad, reached = postures_on(standing, self._mover, points, self._probe, {}, seed)
        return points_mm, q_rad[reached], np.repeat(np.arange(count), each)[reached]
