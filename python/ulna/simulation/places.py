"""Places of some points within an arm's reach, and postures on them: what plans and maps draw from. mm and rad."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ulna.arm.conditions import Conditions, some_of
from ulna.arm.stated import Box
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError
from ulna.simulation.mover import Mover
from ulna.simulation.reading_errors import turns

BARREN = 20
"""Rounds of drawing that find no place before it is said that there is none."""
OTHERS = 8
"""Rounds of other elbows and wrists for a posture that may not be."""


@dataclass(frozen=True)
class Standing:
    """Some points that stand together."""

    features_mm: F64
    """(K, 3)"""
    name: str
    """How messages call it."""
    fixed: bool = False
    """Whether they stand in the arm's frame, where they are."""
    box_mm: Box | None = None
    """Where all of them must be; None: wherever the arm reaches."""
    holds: Callable[[F64], Bool] | None = None
    """(N, K, 3) → (N,) whether they may stand so; None: anyhow."""
    bears: Callable[[F64], Bool] | None = None
    """(N, n) → (N,) whether the arm may be in such poses; None: in all."""


def places(
    standing: Standing,
    mover: Mover,
    probe: int,
    count: int,
    postures: int,
    rng: np.random.Generator,
    temperature_c: float | None = None,
    payload: str | None = None,
) -> tuple[F64, F64]:
    """(count, K, 3) places and directions at random within reach and box, (count, K, postures, n) postures there.

    temperature_c, payload: of the arm, where they matter. Raises UlnaInputError where none are found.
    """
    at: list[F64] = []
    poses: list[F64] = []
    features_mm = standing.features_mm
    missing, barren = count, 0
    while missing and barren < BARREN:
        placed_mm = features_mm[None] if standing.fixed else _near(standing, mover, probe, missing, rng)
        points_mm = np.repeat(placed_mm.reshape(-1, 3), postures, axis=0)
        conditions = mover.arm.conditions(len(points_mm), temperature_c, payload=payload)
        seed = int(rng.integers(2**63))
        q_rad, reached = postures_on(standing, mover, points_mm, probe, conditions, seed)
        shape = (len(placed_mm), len(features_mm), postures)
        whole = np.flatnonzero(reached.reshape(shape).all(axis=(1, 2)))
        at.append(placed_mm[whole])
        poses.append(q_rad.reshape(*shape, mover.arm.n)[whole])
        missing -= len(whole)
        barren = 0 if len(whole) else barren + 1
    if missing:
        raise UlnaInputError(
            f"{standing.name}: only {count - missing} of {count} places were found in which the arm reaches every "
            "feature; expected an artefact that fits. Take a smaller one, a larger box, or a wider travel."
        )
    return np.concatenate(at), np.concatenate(poses)


def postures_on(
    standing: Standing, mover: Mover, points_mm: F64, probe: int, conditions: Conditions, seed: int
) -> tuple[F64, Bool]:
    """(N, n) postures that may be with the tip on (N, 3) points, elbow and wrist at random, and where there is one."""
    q_rad, reached = mover.on_points(points_mm, np.full(len(points_mm), probe), conditions, seed)
    if standing.bears is None:
        return q_rad, reached
    for again in range(1, OTHERS + 1):
        wrong = np.flatnonzero(reached)
        wrong = wrong[~standing.bears(q_rad[wrong])]
        if not len(wrong):
            return q_rad, reached
        own = some_of(conditions, wrong)
        q_rad[wrong], reached[wrong] = mover.on_points(
            points_mm[wrong], np.full(len(wrong), probe), own, (seed + again) % 2**63
        )
    reached[reached] = standing.bears(q_rad[reached])
    return q_rad, reached


def _near(standing: Standing, mover: Mover, probe: int, most: int, rng: np.random.Generator) -> F64:
    """At most so many places at which all points seem to be within reach."""
    drawn = 8 * most + 200
    features_mm, box = standing.features_mm, standing.box_mm
    first_mm = _firsts(box, mover, probe, drawn, rng)
    at_mm = first_mm[:, None] + (features_mm - features_mm[0]) @ turns(features_mm, drawn, rng)
    good = np.ones(drawn, dtype=bool)
    for k in range(len(features_mm)):
        good &= mover.near_reach(np.ascontiguousarray(at_mm[:, k]), probe)
        if box is not None:
            good &= ((at_mm[:, k] >= box[0]) & (at_mm[:, k] <= box[1])).all(axis=1)
    if standing.holds is not None:
        good &= standing.holds(at_mm)
    kept: F64 = at_mm[good][:most]
    return kept


def _firsts(box: Box | None, mover: Mover, probe: int, count: int, rng: np.random.Generator) -> F64:
    """(count, 3) where the first point is: in the box, or wherever the tip can be."""
    if box is not None:
        return rng.uniform(*box, (count, 3))
    return mover.arm.core.tip(mover.anywhere(count, rng), probe)
