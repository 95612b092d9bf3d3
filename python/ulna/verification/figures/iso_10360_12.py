"""The figures of ISO 10360-12:2016, articulated arms with tactile probing, as secondary sources describe them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.enclosing import enclosing_sphere
from ulna.geometry.sphere import Sphere, fit_sphere
from ulna.verification.figures.figure import Definition, Figure, points_of

STANDARD = "ISO 10360-12:2016"

P_SIZE = Definition(
    "P_Size.Sph.1x25:Tact.AArm",
    "P_Size",
    "D_fit - D_cal, signed; D_fit: diameter of the unconstrained least-squares sphere of the probe-centre points of "
    "one ball, less the diameter of the tip (of a hollow: more)",
    STANDARD,
    signed=True,
)
P_FORM = Definition(
    "P_Form.Sph.1x25:Tact.AArm",
    "P_Form",
    "R_max - R_min: largest minus smallest distance of a point from the centre of the same sphere",
    STANDARD,
    signed=False,
)
L_DIA = Definition(
    "L_Dia.5x5:Art:Tact.AArm",
    "L_Dia",
    "diameter of the smallest sphere that holds the centres of the least-squares spheres, one centre for each "
    "orientation of the probe on one ball",
    STANDARD,
    signed=False,
)
E_UNI = Definition(
    "E_Uni:Tact.AArm",
    "E_Uni",
    "L - L_cal, signed: length measured from the same direction, or centre to centre, minus the calibrated length",
    STANDARD,
    signed=True,
)
E_BI = Definition(
    "E_Bi:Tact.AArm",
    "E_Bi",
    "L - L_cal, signed: length measured from opposing directions, the diameter of the tip taken off, minus the "
    "calibrated length",
    STANDARD,
    signed=True,
)


def probing(
    points_mm: ArrayLike, calibrated_mm: float, tip_diameter_mm: float = 0.0, inside: bool = False
) -> tuple[Figure, Figure]:
    """(..., N, 3) probe-centre points on one ball → P_Size and P_Form, (...,).

    `tip_diameter_mm`: 0 where the points are those of the surface already; `inside`: a hollow. Raises UlnaInputError
    where the points determine no sphere.
    """
    return probing_of(fit_sphere(points_mm, "ball"), calibrated_mm, tip_diameter_mm, inside)


def probing_of(
    sphere: Sphere, calibrated_mm: ArrayLike, tip_diameter_mm: float = 0.0, inside: bool = False
) -> tuple[Figure, Figure]:
    """The same of spheres that are fitted already."""
    tip = -tip_diameter_mm if inside else tip_diameter_mm
    return P_SIZE.of(2.0 * sphere.radius_mm - tip - np.asarray(calibrated_mm)), P_FORM.of(sphere.form_mm)


def articulation(points_mm: ArrayLike) -> Figure:
    """(..., O, N, 3) points: N on one ball in each of O orientations of the probe → L_Dia, (...,).

    Raises UlnaInputError where the points of an orientation determine no sphere.
    """
    points = points_of(points_mm, 3, "articulation")
    return L_DIA.of(enclosing_sphere(fit_sphere(points, "ball in one orientation").centre_mm).diameter_mm)


def length_error(length_mm: ArrayLike, calibrated_mm: ArrayLike, opposing: bool = False) -> Figure:
    """(...,) measured and calibrated lengths → E_Uni, or E_Bi where ends are touched from opposing directions."""
    error = np.asarray(length_mm, dtype=np.float64) - np.asarray(calibrated_mm, dtype=np.float64)
    return (E_BI if opposing else E_UNI).of(error)
