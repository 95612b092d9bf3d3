"""What is measured with an arm: a point, a length, a ball, a circle or a plane and their form, the distance of a point
from a plane. Lengths mm.

Each is a function of the tip's positions at some poses, each pose at a named feature; it is evaluated for many sets of
positions of one measurement at once. The first set says which way its normals look.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ulna.geometry.circle import fit_circle
from ulna.geometry.plane import fit_plane
from ulna.geometry.sphere import fit_sphere
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError

MOST_READINGS = 1000
"""Of one measurement: what a plane or a ball is touched at, not a scan."""


FORM = "that noise makes a form larger than it is: the true one may be smaller than all of its interval"
SQUARE = (
    "a wall that is not square to the circle's plane, or an edge in its place: the probe's ball is taken off in that "
    "plane"
)


@dataclass(frozen=True)
class Measurand:
    """A kind of thing to measure."""

    features: dict[str, int]
    """What is touched → how often at the least."""
    units: dict[str, str]
    """Name of each of its values → "mm" or "1"."""
    of: Callable[..., F64]
    """One (T, N, 3) of tip positions for each feature → (T, values)."""
    left_out: tuple[str, ...] = ()
    """What its uncertainty never has, in words."""
    diameter: str | None = None
    """That of its values from which the probe's own ball is taken off, or to which it is added of what is touched from
    within; None where it has no inside."""


def _point(touches: F64) -> F64:
    mean: F64 = touches.mean(axis=1)
    return mean


def _length(a: F64, b: F64) -> F64:
    apart: F64 = np.linalg.norm(b.mean(axis=1) - a.mean(axis=1), axis=1, keepdims=True)
    return apart


def _ball(touches: F64) -> F64:
    """Centre and diameter of the least-squares sphere."""
    found = fit_sphere(touches, "ball")
    return np.concatenate([found.centre_mm, 2.0 * found.radius_mm[:, None]], axis=1)


def _sphericity(touches: F64) -> F64:
    return fit_sphere(touches, "ball").form_mm[:, None]


def _circle(touches: F64) -> F64:
    """Centre and diameter of the least-squares circle, and its normal, towards the base."""
    found = fit_circle(touches, "circle")
    normal = found.normal * _alike(found.normal)
    return np.concatenate([found.centre_mm, 2.0 * found.radius_mm[:, None], normal], axis=1)


def _roundness(touches: F64) -> F64:
    """In the circle's plane: how high touches are is no part of it."""
    return fit_circle(touches, "circle").form_mm[:, None]


def _plane(touches: F64) -> F64:
    """Normal, towards the base, and distance from the origin: both turn with the base frame."""
    found = fit_plane(touches, "plane")
    normal = found.normal * _alike(found.normal)
    d_mm = -(normal * found.point_mm).sum(axis=1, keepdims=True)
    return np.concatenate([normal, d_mm], axis=1)


def _flatness(touches: F64) -> F64:
    return fit_plane(touches, "plane").form_mm[:, None]


def _distance(plane: F64, point: F64) -> F64:
    """Of the mean of the point's touches from the least-squares plane; positive on the base's side."""
    found = fit_plane(plane, "plane")
    return _alike(found.normal) * found.distance_mm(point.mean(axis=1))[:, None]


def _alike(normal: F64) -> F64:
    """(T, 1) 1, or -1 where a normal looks to the other side than the first: of what lies in a plane through the origin
    noise alone would turn it over."""
    return np.where(normal @ normal[0] < 0.0, -1.0, 1.0)[:, None]


_DIAMETER = "diameter"

MEASURANDS: dict[str, Measurand] = {
    "point": Measurand({"point": 1}, {"x": "mm", "y": "mm", "z": "mm"}, _point),
    "length": Measurand({"A": 1, "B": 1}, {"length": "mm"}, _length),
    "ball": Measurand({"ball": 4}, {"x": "mm", "y": "mm", "z": "mm", _DIAMETER: "mm"}, _ball, diameter=_DIAMETER),
    "sphericity": Measurand({"ball": 5}, {"form": "mm"}, _sphericity, (FORM,)),
    "circle": Measurand(
        {"circle": 3},
        {"x": "mm", "y": "mm", "z": "mm", _DIAMETER: "mm", "n_x": "1", "n_y": "1", "n_z": "1"},
        _circle,
        (SQUARE,),
        _DIAMETER,
    ),
    "roundness": Measurand({"circle": 4}, {"form": "mm"}, _roundness, (FORM,)),
    "plane": Measurand({"plane": 3}, {"n_x": "1", "n_y": "1", "n_z": "1", "d": "mm"}, _plane),
    "flatness": Measurand({"plane": 4}, {"form": "mm"}, _flatness, (FORM,)),
    "distance": Measurand({"plane": 3, "point": 1}, {"distance": "mm"}, _distance),
}


@dataclass(frozen=True)
class Touched:
    """A measurand and which pose is at which of its features."""

    kind: str
    feature: I64
    """(N,) index into the measurand's features."""

    @property
    def measurand(self) -> Measurand:
        """What it is."""
        return MEASURANDS[self.kind]

    def check(self, label: str) -> None:
        """Raises UlnaInputError where a feature is not touched often enough; label: what to call the readings."""
        if len(self.feature) > MOST_READINGS:
            raise UlnaInputError(
                f"{label}: {len(self.feature)} readings; expected at most {MOST_READINGS} of one measurement. Take "
                "fewer, or use `ulna measure` for many points."
            )
        for number, (name, least) in enumerate(self.measurand.features.items()):
            count = int((self.feature == number).sum())
            if count < least:
                raise UlnaInputError(
                    f"{label}: {count} readings of feature '{name}', but a {self.kind} needs {least} at the least. "
                    "Take more, or correct the column feature."
                )

    def values(self, tips_mm: F64, like_mm: F64 | None = None) -> F64:
        """(T, N, 3) tip positions → (T, values), in their units; like_mm: (N, 3) tips whose normals look the way in
        which these shall, in place of the first's."""
        sets = tips_mm if like_mm is None else np.concatenate([like_mm[None], tips_mm])
        groups = (sets[:, self.feature == k] for k in range(len(self.measurand.features)))
        return self.measurand.of(*groups)[len(sets) - len(tips_mm) :]

    def gradient(self, tips_mm: F64) -> F64:
        """(values, N, 3): ∂value/∂coordinate at (N, 3) tips, by central differences."""
        count = len(tips_mm)
        h = 1e-3
        moved = np.repeat(tips_mm[None], 6 * count, axis=0).reshape(count, 3, 2, count, 3)
        for n in range(count):
            for j in range(3):
                moved[n, j, 0, n, j] += h
                moved[n, j, 1, n, j] -= h
        values = self.values(moved.reshape(-1, count, 3), tips_mm).reshape(count, 3, 2, -1)
        gradient: F64 = np.moveaxis((values[:, :, 0] - values[:, :, 1]) / (2.0 * h), -1, 0)
        return gradient
