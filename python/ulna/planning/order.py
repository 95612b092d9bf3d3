"""The order of work: the artefact is moved seldom, and the arm not far."""

from __future__ import annotations

import numpy as np

from ulna.ground.arrays import F64, I64
from ulna.planning.candidates import Candidates


def in_order(chosen: Candidates) -> Candidates:
    """Place after place by short ways, and in each place measurement after measurement by short moves of the joints."""
    places = np.unique(chosen.place)
    centres = chosen.features_mm[places].mean(axis=1)
    around = places[nearest_first(centres)]
    start = chosen.poses(np.arange(len(chosen))).reshape(len(chosen), -1)
    order: list[int] = []
    for place in around.tolist():
        own = np.flatnonzero(chosen.place == place)
        order += own[nearest_first(start[own])].tolist()
    return chosen.select(np.array(order, dtype=np.int64))


def nearest_first(points: F64) -> I64:
    """An order of (N, d) points: from the first on always to the nearest that is left."""
    left = list(range(1, len(points)))
    order = [0]
    while left:
        far = np.linalg.norm(points[left] - points[order[-1]], axis=1)
        order.append(left.pop(int(far.argmin())))
    return np.array(order, dtype=np.int64)
