"""Measurements that could be taken: places of the artefact, postures at each feature, and combinations of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, I64
from ulna.planning.spec import PlanSpec
from ulna.planning.touchable import touchable
from ulna.simulation.mover import Mover
from ulna.simulation.places import places

POSTURES = 10
"""At each feature in a place, for each touch that a measurement takes of it."""
ON_SURFACE = 4
"""At each place on a surface: there are many of them."""
EACH = 100
"""Measurements combined of these in one place, where the number of places is free: the square of POSTURES."""


@dataclass(frozen=True)
class Candidates:
    """N measurements in S places."""

    features_mm: F64
    """(S, K, 3) where the features are, base frame."""
    q_rad: F64
    """(S, K, m, n) postures at each."""
    place: I64
    """(N,) which place."""
    picked: I64
    """(N, K, t) which postures of each feature."""

    def __len__(self) -> int:
        return len(self.place)

    def poses(self, which: I64) -> F64:
        """(len(which), K, t, n) encoder angles of some."""
        k = np.arange(self.q_rad.shape[1])[None, :, None]
        return self.q_rad[self.place[which][:, None, None], k, self.picked[which]]

    def select(self, which: I64) -> Candidates:
        """Only some of them; the places stay."""
        return Candidates(self.features_mm, self.q_rad, self.place[which], self.picked[which])


def places_of(spec: PlanSpec) -> int:
    """In how many places candidates stand."""
    return 1 if spec.artefact.frame == "arm" else max(1, -(-spec.candidates // EACH))


def draw(spec: PlanSpec, mover: Mover, probe: int, rng: np.random.Generator, count: int | None = None) -> Candidates:
    """`spec.candidates` measurements, or nearly; count: only those of so many places. Raises UlnaInputError."""
    what = touchable(spec, mover.arm, probe)
    each = -(-spec.candidates // places_of(spec))
    if what.pairs:
        postures = max(2, int(np.ceil(np.sqrt(each))))
    else:
        postures = POSTURES * what.touches if what.outward is None else ON_SURFACE
    at_mm, q_rad = places(
        what.standing(spec, mover.arm), mover, probe, places_of(spec) if count is None else count, postures, rng
    )
    return combine(at_mm, q_rad, each, what.touches, rng)


def joined(parts: list[Candidates]) -> Candidates:
    """All of them, in order."""
    firsts = np.cumsum([0, *(len(part.features_mm) for part in parts)])
    return Candidates(
        np.concatenate([part.features_mm for part in parts]),
        np.concatenate([part.q_rad for part in parts]),
        np.concatenate([part.place + first for part, first in zip(parts, firsts[:-1], strict=True)]),
        np.concatenate([part.picked for part in parts]),
    )


def combine(at_mm: F64, q_rad: F64, each: int, touches: int, rng: np.random.Generator) -> Candidates:
    """`each` measurements in each place: all pairs where two features are touched once, else drawn."""
    count, features, postures, _ = q_rad.shape
    if features == 2 and touches == 1:
        a, b = (grid.ravel()[:each] for grid in np.meshgrid(range(postures), range(postures), indexing="ij"))
        picked = np.tile(np.stack([a, b], axis=1)[..., None], (count, 1, 1))
        each = len(a)
    else:
        drawn = rng.random((count * each, features, postures)).argsort(axis=2)
        picked = np.sort(drawn[..., :touches], axis=2)
    return Candidates(at_mm, q_rad, np.repeat(np.arange(count), each), picked.astype(np.int64))
