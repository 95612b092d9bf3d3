"""Measurements that could be taken: places of the artefact, postures at each feature, and combinations of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ulna.errors import UlnaInputError
from ulna.plan_spec import Box, PlanSpec
from ulna.virtual.arm import turns
from ulna.virtual.postures import Mover

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

POSTURES = 10
"""At each feature in a place, for each touch that a measurement takes of it."""
EACH = 100
"""Measurements combined of these in one place, where the number of places is free: the square of POSTURES."""
BARREN = 20
"""Rounds of drawing that find no place before it is said that there is none."""


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


def draw(spec: PlanSpec, mover: Mover, probe: int, rng: np.random.Generator, places: int | None = None) -> Candidates:
    """`spec.candidates` measurements, or nearly. places: in so many places. Raises UlnaInputError."""
    features_mm = np.array(list(spec.artefact.features.values()), dtype=np.float64)
    if spec.artefact.frame == "arm":
        places = 1
    pairs = len(features_mm) == 2 and spec.touches == 1
    count = max(1, -(-spec.candidates // EACH)) if places is None else places
    each = -(-spec.candidates // count)
    postures = max(2, int(np.ceil(np.sqrt(each)))) if pairs else POSTURES * spec.touches
    at_mm, q_rad = stand(spec, mover, probe, features_mm, count, postures, spec.room_mm, rng)
    return combine(at_mm, q_rad, each, spec.touches, rng)


def combine(at_mm: F64, q_rad: F64, each: int, touches: int, rng: np.random.Generator) -> Candidates:
    """`each` measurements in each place: all pairs where two features are touched once, else drawn."""
    places, features, postures, _ = q_rad.shape
    if features == 2 and touches == 1:
        a, b = (grid.ravel()[:each] for grid in np.meshgrid(range(postures), range(postures), indexing="ij"))
        picked = np.tile(np.stack([a, b], axis=1)[..., None], (places, 1, 1))
        each = len(a)
    else:
        drawn = rng.random((places * each, features, postures)).argsort(axis=2)
        picked = np.sort(drawn[..., :touches], axis=2)
    return Candidates(at_mm, q_rad, np.repeat(np.arange(places), each), picked.astype(np.int64))


def stand(
    spec: PlanSpec,
    mover: Mover,
    probe: int,
    features_mm: F64,
    count: int,
    postures: int,
    box: Box | None,
    rng: np.random.Generator,
) -> tuple[F64, F64]:
    """(count, K, 3) places and directions at random within reach and box, (count, K, postures, n) postures there.

    Raises UlnaInputError where none are found.
    """
    at: list[F64] = []
    poses: list[F64] = []
    missing, barren = count, 0
    fixed = spec.artefact.frame == "arm"
    while missing and barren < BARREN:
        placed_mm = features_mm[None] if fixed else _near(mover, probe, features_mm, missing, box, rng)
        points_mm = np.repeat(placed_mm.reshape(-1, 3), postures, axis=0)
        q_rad, reached = mover.on_points(points_mm, np.full(len(points_mm), probe), None, int(rng.integers(2**63)))
        shape = (len(placed_mm), len(features_mm), postures)
        whole = np.flatnonzero(reached.reshape(shape).all(axis=(1, 2)))
        at.append(placed_mm[whole])
        poses.append(q_rad.reshape(*shape, mover.arm.n)[whole])
        missing -= len(whole)
        barren = 0 if len(whole) else barren + 1
    if missing:
        raise UlnaInputError(
            f"{spec.label}: artefact '{spec.artefact.name}': only {count - missing} of {count} places were found in "
            "which the arm reaches every feature; expected an artefact that fits. Take a smaller one, a larger box, or "
            "a wider travel."
        )
    return np.concatenate(at), np.concatenate(poses)


def _near(mover: Mover, probe: int, features_mm: F64, most: int, box: Box | None, rng: np.random.Generator) -> F64:
    """At most so many places at which all features seem to be within reach."""
    drawn = 8 * most + 200
    anywhere = mover.arm.core.tip(mover.anywhere(drawn, rng), probe)
    first_mm = anywhere if box is None else rng.uniform(*box, (drawn, 3))
    at_mm = first_mm[:, None] + (features_mm - features_mm[0]) @ turns(features_mm, drawn, rng)
    good = np.ones(drawn, dtype=bool)
    for k in range(len(features_mm)):
        good &= mover.near_reach(np.ascontiguousarray(at_mm[:, k]), probe)
        if box is not None:
            good &= ((at_mm[:, k] >= box[0]) & (at_mm[:, k] <= box[1])).all(axis=1)
    kept: F64 = at_mm[good][:most]
    return kept
