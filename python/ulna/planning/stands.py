"""A plan stand by stand: where a person puts the artefact, how it lies there, and how the arm is held at each touch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.arm.data import ArmData
from ulna.ground.arrays import F64, I64
from ulna.planning.within import joints_mm

LEVEL_DEG, UPRIGHT_DEG = 3.0, 80.0
"""Slopes that a person calls level, and upright."""
SIDES = ("up", "up-right", "right", "down-right", "down", "down-left", "left", "up-left")
"""Clockwise, seen along the line from the shoulder to the tip."""
FROM = ("above", "below", "left", "right", "near", "far")
"""Where the last joint is, seen from the tip by somebody behind the base who looks at the tip."""


@dataclass(frozen=True)
class Stand:
    """One place of the artefact."""

    number: int
    """From 1, in the order of work: the column `stand` of plan.csv."""
    points_mm: F64
    """(K, 3) where the features (or touches of a surface) are, base frame."""
    measurements: I64
    """(M,) numbers of its measurements, from 1: the column `placement`."""

    @property
    def azimuth_deg(self) -> float:
        """Direction from the first to the last point seen from above, from x towards y, 0° to 360°."""
        x, y, _ = self.points_mm[-1] - self.points_mm[0]
        return float(np.degrees(np.arctan2(y, x)) % 360.0)

    @property
    def slope_deg(self) -> float:
        """How steeply the last point is above the first."""
        x, y, z = self.points_mm[-1] - self.points_mm[0]
        return float(np.degrees(np.arctan2(z, np.hypot(x, y))))

    @property
    def lies(self) -> str:
        """ "level", "rising", "falling", "upright", "hanging", or "nowhere" of a single point."""
        if float(np.linalg.norm(self.points_mm[-1] - self.points_mm[0])) < 1e-6:
            return "nowhere"
        steep = abs(self.slope_deg)
        if steep > UPRIGHT_DEG:
            return "upright" if self.slope_deg > 0.0 else "hanging"
        return "level" if steep < LEVEL_DEG else "rising" if self.slope_deg > 0.0 else "falling"


def stands_of(place: I64, features_mm: F64) -> list[Stand]:
    """The stands of measurements in their order of work: place (N,), features_mm (S, K, 3) by place."""
    begins = np.flatnonzero(np.concatenate([[True], np.diff(place) != 0]))
    ends = [*begins[1:].tolist(), len(place)]
    return [
        Stand(number, features_mm[place[begin]], np.arange(begin, end) + 1)
        for number, (begin, end) in enumerate(zip(begins.tolist(), ends, strict=True), start=1)
    ]


def elbow_sides(arm: ArmData, q_rad: F64, tip_mm: F64) -> list[str | None]:
    """(N,) to which side of the line from the second joint to the tip (N, 3) the joint is that is farthest off it; None
    where the arm is straight, or its line upright. (N, n) poses."""
    joints = joints_mm(arm, q_rad)
    shoulder = joints[:, 1]
    along = _unit(tip_mm - shoulder)
    off = joints[:, 2:] - shoulder[:, None]
    off = off - np.einsum("nki,ni->nk", off, along)[..., None] * along[:, None]
    size = np.linalg.norm(off, axis=2)
    if not size.shape[1]:
        return [None] * len(q_rad)
    elbow = off[np.arange(len(off)), size.argmax(axis=1)]
    right = _across(along)
    up = np.cross(right, along)
    angle = np.degrees(np.arctan2((elbow * right).sum(axis=1), (elbow * up).sum(axis=1)))
    sector = np.round(angle / 45.0).astype(int) % 8
    straight = (size.max(axis=1) < 1.0) | (np.abs(along[:, 2]) > 0.999)
    return [None if none else SIDES[k] for none, k in zip(straight.tolist(), sector.tolist(), strict=True)]


def probe_from(arm: ArmData, q_rad: F64, tip_mm: F64) -> list[str]:
    """(N,) from where the probe comes: the side of the tip (N, 3) on which the last joint is. (N, n) poses."""
    back = joints_mm(arm, q_rad)[:, -1] - tip_mm
    level = _unit(np.concatenate([tip_mm[:, :2], np.zeros((len(tip_mm), 1))], axis=1))
    right = np.stack([level[:, 1], -level[:, 0], np.zeros(len(level))], axis=1)
    shares = np.stack([back[:, 2], (back * right).sum(axis=1), -(back * level).sum(axis=1)], axis=1)
    axis = np.abs(shares).argmax(axis=1)
    positive = shares[np.arange(len(shares)), axis] > 0.0
    pairs = (("above", "below"), ("right", "left"), ("near", "far"))
    return [pairs[k][0 if up else 1] for k, up in zip(axis.tolist(), positive.tolist(), strict=True)]


def runs(numbers: Sequence[int]) -> str:
    """1, 2, 3, 7 as "1–3, 7"."""
    found: list[list[int]] = []
    for number in numbers:
        if found and number == found[-1][1] + 1:
            found[-1][1] = number
        else:
            found.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}–{b}" for a, b in found)


def _unit(vectors: F64) -> F64:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    found: F64 = np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)
    return found


def _across(along: F64) -> F64:
    """(N, 3) level unit vectors to the right of directions."""
    return _unit(np.stack([along[:, 1], -along[:, 0], np.zeros(len(along))], axis=1))
