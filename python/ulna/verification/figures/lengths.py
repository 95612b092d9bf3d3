"""A length from the touches of its two ends: what every length test stands on. Lengths mm."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.plane import fit_plane
from ulna.geometry.sphere import fit_sphere
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.verification.certified import Ends
from ulna.verification.figures.figure import points_of

FORMULAS: dict[str, str] = {
    "seats": "distance between the means of the touches in seats A and B",
    "balls": "distance between the centres of the least-squares spheres of balls A and B",
    "faces": "distance of the mean of the touches of face B from face A, both touched from the same direction",
    "opposite-faces": "distance of the mean of the touches of face B from face A, less the diameter of the tip",
}
"""How a length is taken between ends of each kind. Face A is the least-squares plane of its touches; of one or two
touches it is their mean, and the distance is that of two points."""

OPPOSING = ("opposite-faces",)
"""Ends that are touched from opposing directions."""


def length_between(a_mm: ArrayLike, b_mm: ArrayLike, ends: Ends, tip_diameter_mm: float | None = None) -> F64:
    """(..., N, 3) and (..., M, 3) centres of the probe's ball at the two ends → (...,) lengths.

    `tip_diameter_mm` is needed for opposite faces alone. Raises UlnaInputError where it is missing, or where touches
    determine no sphere or plane.
    """
    a, b = points_of(a_mm, 2, "end A"), points_of(b_mm, 2, "end B")
    if ends == "balls":
        return _apart(fit_sphere(a, "ball A").centre_mm, fit_sphere(b, "ball B").centre_mm)
    middle = b.mean(axis=-2)
    if ends == "seats":
        return _apart(a.mean(axis=-2), middle)
    few = a.shape[-2] < 3
    length = _apart(a.mean(axis=-2), middle) if few else np.abs(fit_plane(a, "face A").distance_mm(middle))
    if ends == "faces":
        return length
    if tip_diameter_mm is None:
        raise UlnaInputError(
            "a length between opposite faces: the diameter of the probe's ball is not known; expected it, because it "
            "is taken off. State it."
        )
    return length - tip_diameter_mm


def _apart(a: F64, b: F64) -> F64:
    return np.asarray(np.linalg.norm(b - a, axis=-1))
