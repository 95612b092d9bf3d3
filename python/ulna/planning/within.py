"""Where a person can put an artefact and hold the arm: above the table that the base stands on. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.data import ArmData
from ulna.arm.frames.bodies import constant_transforms, turns
from ulna.ground.arrays import F64, Bool

ALONG = 9
"""Points between two features at which it is asked whether the artefact runs through the base."""


@dataclass(frozen=True)
class Within:
    """What a person can reach who stands at the table, and what the table and the base leave of the room."""

    table_mm: float = 0.0
    """z of the table in the base frame."""
    low_mm: float = 0.0
    """Lowest height of a feature above the table."""
    high_mm: float = 1000.0
    """Highest: at a table of 0.75 m it is 1.75 m above the floor."""
    aside_mm: float = 150.0
    """Nothing of the artefact is nearer to the base's z axis: there stand the base and the column."""

    def holds(self, features_mm: F64) -> Bool:
        """(N,) whether the artefact with its features at (N, K, 3) stands there, base frame."""
        height = features_mm[:, :, 2] - self.table_mm
        good = np.asarray(((height >= self.low_mm) & (height <= self.high_mm)).all(axis=1))
        share = np.linspace(0.0, 1.0, ALONG)[:, None, None]
        start, stop = features_mm, np.roll(features_mm, -1, axis=1)
        along = start[:, None] + share * (stop - start)[:, None]
        return good & np.asarray((np.hypot(along[..., 0], along[..., 1]) >= self.aside_mm).all(axis=(1, 2)))

    def bears(self, arm: ArmData, q_rad: F64) -> Bool:
        """(N,) whether all joints behind the second are above the table in (N, n) poses."""
        return np.asarray((joints_mm(arm, q_rad)[:, 2:, 2] >= self.table_mm).all(axis=1))


def joints_mm(arm: ArmData, q_rad: F64) -> F64:
    """(N, n, 3) where the origin of each joint's frame is, base frame, of links and axes alone: no effects beyond
    geometry but coupled joints."""
    turned = q_rad @ turns(arm).T
    count = len(q_rad)
    rotation, origin = np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3))
    found = np.empty((count, arm.n, 3))
    for k, before in enumerate(constant_transforms(arm)[: arm.n]):
        origin = origin + rotation @ before[:3, 3]
        found[:, k] = origin
        c, s, zero, one = np.cos(turned[:, k]), np.sin(turned[:, k]), np.zeros(count), np.ones(count)
        about = np.stack([c, -s, zero, s, c, zero, zero, zero, one], axis=1).reshape(-1, 3, 3)
        rotation = rotation @ before[:3, :3] @ about
    return found
