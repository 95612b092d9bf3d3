"""What a picture of an arm is made of: shapes, each fixed to one body and given in its frame, mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ulna.ground.arrays import F64

Kind = Literal["line", "solid", "face", "ball", "word"]
"""line: through its points; solid: the convex hull of its points; face: a polygon, seen from the side from which its
points run counter-clockwise; ball: about its point; word: at its point."""
Group = Literal["floor", "arm", "axes", "frames", "dimensions"]
"""What is shown or left out together."""


@dataclass(frozen=True)
class Shape:
    """One thing to draw."""

    kind: Kind
    body: int
    """0: the base; k: what turns with joint k."""
    group: Group
    role: str
    """By which a medium knows its colours: a row of `ulna.pictures.looks.LOOKS`."""
    points_mm: F64
    """(N, 3) in the body's frame."""
    joint: int = 0
    """Whose part it is: joint k and the link behind it; 0: of none."""
    text: str = ""
    """Of a word."""
    radius_mm: float = 0.0
    """Of a ball."""


def ring(centre_mm: ArrayLike, normal: ArrayLike, radius_mm: float, count: int) -> F64:
    """(count, 3) points on a circle, counter-clockwise seen against its unit normal."""
    n = np.asarray(normal, dtype=np.float64)
    across = _across(n)
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)[:, None]
    found: F64 = np.asarray(centre_mm) + radius_mm * (np.cos(angle) * across + np.sin(angle) * np.cross(n, across))
    return found


def tube(start_mm: ArrayLike, end_mm: ArrayLike, radius_mm: float, count: int = 10) -> F64:
    """(2 count, 3) points whose hull is a cylinder; (0, 3) where it has no length to speak of."""
    start, end = np.asarray(start_mm, dtype=np.float64), np.asarray(end_mm, dtype=np.float64)
    length = float(np.linalg.norm(end - start))
    if length < 1e-6:
        return np.zeros((0, 3))
    along = (end - start) / length
    return np.concatenate([ring(start, along, radius_mm, count), ring(end, along, radius_mm, count)])


def cone(base_mm: F64, tip_mm: F64, radius_mm: float) -> F64:
    """(9, 3) points whose hull is the head of an arrow."""
    along = (tip_mm - base_mm) / float(np.linalg.norm(tip_mm - base_mm))
    return np.concatenate([ring(base_mm, along, radius_mm, 8), tip_mm[None]])


def arc(centre_mm: ArrayLike, start: ArrayLike, about: ArrayLike, angle_rad: float, radius_mm: float) -> F64:
    """(N, 3) points from the unit direction `start`, turned by an angle about the unit vector `about`, which is
    perpendicular to it."""
    s, n = np.asarray(start, dtype=np.float64), np.asarray(about, dtype=np.float64)
    steps = max(2, int(abs(angle_rad) / 0.12) + 1)
    t = np.linspace(0.0, angle_rad, steps)[:, None]
    found: F64 = np.asarray(centre_mm) + radius_mm * (np.cos(t) * s + np.sin(t) * np.cross(n, s))
    return found


def at(transform: F64, points_mm: ArrayLike) -> F64:
    """(N, 3) points of a frame, in the frame in which that stands at (4, 4) `transform`."""
    found: F64 = np.asarray(points_mm, dtype=np.float64).reshape(-1, 3) @ transform[:3, :3].T + transform[:3, 3]
    return found


def extent(points: Sequence[F64]) -> tuple[F64, float]:
    """Middle of the box about all points, and how far the farthest is from it."""
    all_of = np.concatenate(list(points))
    middle: F64 = (all_of.min(axis=0) + all_of.max(axis=0)) / 2.0
    return middle, float(np.linalg.norm(all_of - middle, axis=1).max())


def _across(normal: F64) -> F64:
    """(3,) some unit vector perpendicular to it: x where it is z."""
    helper = np.array([0.0, 1.0, 0.0]) if abs(normal[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    across = np.cross(helper, normal)
    found: F64 = across / float(np.linalg.norm(across))
    return found
