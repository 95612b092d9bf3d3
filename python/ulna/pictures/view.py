"""A scene in a pose, seen from somewhere in parallel projection: flat marks in the order in which they are painted.

The page of `ulna show` does the same in its script (`ulna.documents.arm_page`), and a test holds them to each other.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ulna.arm.frames.bodies import bodies
from ulna.ground.arrays import F64
from ulna.pictures.scene import Scene
from ulna.pictures.shapes import Group, Shape, at

AZIMUTH_RAD, ELEVATION_RAD = math.radians(-58.0), math.radians(22.0)
"""From where an arm is seen unless somebody turns it."""
LEAST_BALL_PX = 3.5
NAME_PX = 4.0
"""Names stand so far above their points."""
#: what covers what: later ones lie on earlier ones
ORDER = ("floor", "arm", "over", "word")
#: kinds that are never hidden
ON_TOP = {"word": "word", "ball": "over"}
FILLED = 0.54
"""Of the shorter side of the picture: the distance from the middle of an arm to its farthest part."""
Marks = list["Mark"]


@dataclass(frozen=True)
class View:
    """Where the eye is, and how large things are."""

    azimuth_rad: float
    """Of the eye, about z from x."""
    elevation_rad: float
    centre_mm: F64
    """(3,) what is in the middle."""
    px_per_mm: float
    width_px: float
    height_px: float

    def axes(self) -> F64:
        """(3, 3): to the right, up, and towards the eye, as rows."""
        ca, sa = math.cos(self.azimuth_rad), math.sin(self.azimuth_rad)
        ce, se = math.cos(self.elevation_rad), math.sin(self.elevation_rad)
        return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])

    def seen(self, points_mm: F64) -> F64:
        """(N, 3): px to the right and down, and how near in mm."""
        right, up, near = ((points_mm - self.centre_mm) @ self.axes().T).T
        scale = self.px_per_mm
        return np.stack([self.width_px / 2.0 + scale * right, self.height_px / 2.0 - scale * up, near], axis=1)


@dataclass(frozen=True)
class Mark:
    """One flat mark."""

    form: str
    """"line", "area", "circle" or "word"."""
    group: Group
    role: str
    joint: int
    points_px: F64
    """(N, 2); of a circle or word one."""
    radius_px: float = 0.0
    text: str = ""


def marks(scene: Scene, q_rad: F64, view: View) -> Marks:
    """All that is seen, in the order of painting: what is nearer comes later."""
    stand = bodies(scene.arm, q_rad)
    found = []
    for k, shape in enumerate(scene.shapes):
        seen = view.seen(at(stand[shape.body], shape.points_mm))
        mark = FORMS[shape.kind](shape, seen, view)
        if mark is not None:
            found.append((ORDER.index(layer(shape)), float(seen[:, 2].mean()), k, mark))
    return [mark for *_, mark in sorted(found, key=lambda each: each[:3])]


def layer(shape: Shape) -> str:
    """Frames, axes and dimensions lie on the arm, as if it were of glass."""
    if shape.kind in ON_TOP:
        return ON_TOP[shape.kind]
    return shape.group if shape.group in ORDER else "over"


def around(scene: Scene, q_rad: F64, width_px: float, height_px: float) -> View:
    """The arm in the middle, as large as it may be to be turned about: some of it may then touch the edge."""
    middle, radius = scene.extent(q_rad)
    scale = FILLED * min(width_px, height_px) / radius
    return View(AZIMUTH_RAD, ELEVATION_RAD, middle, scale, width_px, height_px)


def fitted(scene: Scene, q_rad: F64, width_px: float, most_px: float, azimuth_rad: float, elevation_rad: float) -> View:
    """As large as the width allows, as high as the arm then needs, `most_px` at the most."""
    view = View(azimuth_rad, elevation_rad, np.zeros(3), 1.0, 0.0, 0.0)
    stand = bodies(scene.arm, q_rad)
    seen = np.concatenate([
        view.seen(at(stand[s.body], s.points_mm)) for s in scene.shapes if s.group in ("arm", "axes", "frames")
    ])  # fmt: skip
    low, high = seen.min(axis=0), seen.max(axis=0)
    wide, tall = (high - low)[:2].tolist()
    margin = 0.05 * width_px + 12.0
    scale = min((width_px - 2.0 * margin) / wide, (most_px - 2.0 * margin) / tall)
    right, down, near = ((low + high) / 2.0).tolist()
    centre = np.array([right, -down, near]) @ view.axes()
    return View(azimuth_rad, elevation_rad, centre, scale, width_px, tall * scale + 2.0 * margin)


def hull(points: F64) -> F64:
    """(M, 2) corners of the convex hull of (N, 2) points, by Andrew's monotone chain (1979)."""
    ordered = sorted(map(tuple, points.tolist()))
    ends: list[list[tuple[float, float]]] = []
    for run in (ordered, ordered[::-1]):
        kept: list[tuple[float, float]] = []
        for x, y in run:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], (x, y)) <= 0.0:
                kept.pop()
            kept.append((x, y))
        ends.append(kept[:-1])
    corners = ends[0] + ends[1]
    # of corners above one another, which processors round apart, the same is always the first
    first = min(range(len(corners)), key=lambda k: tuple(round(each, 3) for each in corners[k]))
    return np.array(corners[first:] + corners[:first])


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _line(shape: Shape, seen: F64, _: View) -> Mark:
    return Mark("line", shape.group, shape.role, shape.joint, seen[:, :2])


def _solid(shape: Shape, seen: F64, _: View) -> Mark:
    return Mark("area", shape.group, shape.role, shape.joint, hull(seen[:, :2]))


def _face(shape: Shape, seen: F64, _: View) -> Mark | None:
    """Seen from its front only: px run down, so counter-clockwise has a negative area."""
    x, y = seen[:, 0], seen[:, 1]
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return Mark("area", shape.group, shape.role, shape.joint, seen[:, :2]) if area < 0.0 else None


def _ball(shape: Shape, seen: F64, view: View) -> Mark:
    radius = max(shape.radius_mm * view.px_per_mm, LEAST_BALL_PX)
    return Mark("circle", shape.group, shape.role, shape.joint, seen[:, :2], radius)


def _word(shape: Shape, seen: F64, _: View) -> Mark:
    return Mark("word", shape.group, shape.role, shape.joint, seen[:, :2], text=shape.text)


#: kind of shape → its mark
FORMS: dict[str, Callable[[Shape, F64, View], Mark | None]] = {
    "line": _line,
    "solid": _solid,
    "face": _face,
    "ball": _ball,
    "word": _word,
}
