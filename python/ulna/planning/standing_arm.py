"""The arm as it touches the first point of a plan, and the artefact in all its places: one picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64
from ulna.pictures.scene import Scene, scene
from ulna.pictures.shapes import Shape, ring, tube
from ulna.pictures.svg import picture, standalone
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, fitted
from ulna.planning.stands import Stand

WIDTH_PX, MOST_PX = 900.0, 800.0
GROUPS = ("arm", "floor")


def arm_and_stands(arm: Arm, probe: str | None, stands: list[Stand]) -> Scene:
    """The arm with a probe on (None: its only one), the floor at z = 0 of the base frame, the artefact with numbers."""
    drawn = scene(arm, probe)
    shapes = [each for each in drawn.shapes if each.group in GROUPS and each.role != "grid-name"]
    return replace(drawn, shapes=[*shapes, *(shape for stand in stands for shape in _stand(stand, drawn.reach_mm))])


def svg(arm: Arm, probe: str | None, stands: list[Stand], q_rad: F64) -> str:
    """As a file that follows the reader's light or dark; (n,) pose."""
    drawn = arm_and_stands(arm, probe, stands)
    view = fitted(drawn, q_rad, WIDTH_PX, MOST_PX, AZIMUTH_RAD, ELEVATION_RAD)
    title = f"Arm {arm.name} at the first of {len(stands)} stands of the artefact"
    return standalone(picture(drawn, q_rad, view, title, GROUPS))


def _stand(stand: Stand, reach_mm: float) -> Iterator[Shape]:
    """The artefact as a rod from point to point, and its number."""
    points = stand.points_mm
    for start, stop in pairwise(points):
        rod = tube(start, stop, 0.004 * reach_mm, 8)
        if len(rod):
            yield Shape("solid", 0, "arm", "artefact", rod)
    for point in points[[0, -1]] if len(points) > 1 else points:
        # a ball that the arm can hide: balls of `Shape` lie on top of everything
        rings = [ring(point, normal, 0.009 * reach_mm, 12) for normal in np.eye(3)]
        yield Shape("solid", 0, "arm", "artefact-end", np.concatenate(rings))
    yield Shape("word", 0, "arm", "artefact-name", np.array([points.mean(axis=0)]), text=str(stand.number))
