"""The figures of ASME B89.4.22-2004 (R2019), articulated arms, as secondary sources describe them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.sphere import fit_sphere
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.verification.figures.figure import Definition, Figure, points_of, spread_of

STANDARD = "ASME B89.4.22-2004 (R2019)"

DIAMETER = Definition(
    "Effective diameter: deviation of the mean",
    "Diameter_mean",
    "mean(D_i) - D_cal, signed; D_i: diameter of the least-squares sphere of one measurement of the ball, less the "
    "diameter of the tip",
    STANDARD,
    signed=True,
)
DIAMETER_WORST = Definition(
    "Effective diameter: largest deviation",
    "Diameter_max",
    "the D_i - D_cal of the largest size, signed",
    STANDARD,
    signed=True,
)
DIAMETER_SPREAD = Definition(
    "Effective diameter: standard deviation",
    "Diameter_s",
    "√(Σ(D_i - mean(D))² / (n - 1))",
    STANDARD,
    signed=False,
)
SPAT_MAX = Definition(
    "Single-point articulation: largest deviation",
    "SPAT_max",
    "max δ_i, δ_i = ‖p_i - mean(p)‖, over the touches of one seat",
    STANDARD,
    signed=False,
)
SPAT_2S = Definition(
    "Single-point articulation: 2·S",
    "SPAT_2S",
    "2 √(Σδ_i² / (n - 1)), δ_i = ‖p_i - mean(p)‖, over the n touches of one seat",
    STANDARD,
    signed=False,
)
VOLUMETRIC_MAX = Definition(
    "Volumetric: largest deviation",
    "Volumetric_max",
    "the L_i - L_cal,i of the largest size, signed, over the ball bar's positions",
    STANDARD,
    signed=True,
)
VOLUMETRIC_2S = Definition(
    "Volumetric: 2 standard deviations",
    "Volumetric_2S",
    "2 √(Σ(e_i - mean(e))² / (n - 1)), e_i = L_i - L_cal,i",
    STANDARD,
    signed=False,
)
VOLUMETRIC_HALF_RANGE = Definition(
    "Volumetric: half the range",
    "Volumetric_half_range",
    "(max e_i - min e_i) / 2, e_i = L_i - L_cal,i",
    STANDARD,
    signed=False,
)
VOLUMETRIC_2RMS = Definition(
    "Volumetric: 2·RMS",
    "Volumetric_2RMS",
    "2 √(Σe_i² / n), e_i = L_i - L_cal,i: other than 2 standard deviations, it holds the mean error",
    STANDARD,
    signed=False,
)


def effective_diameter(
    points_mm: ArrayLike, calibrated_mm: float, tip_diameter_mm: float = 0.0
) -> tuple[Figure, Figure, Figure]:
    """(..., R, N, 3) probe-centre points: N on the ball in each of R measurements → deviation of the mean, largest
    deviation, standard deviation, each (...,). Raises UlnaInputError where points determine no sphere."""
    points = points_of(points_mm, 3, "effective diameter")
    diameter_mm = 2.0 * fit_sphere(points, "ball").radius_mm - tip_diameter_mm
    return effective_diameter_of(diameter_mm - calibrated_mm)


def effective_diameter_of(deviation_mm: F64) -> tuple[Figure, Figure, Figure]:
    """The same of the measurements' deviations D_i - D_cal, (..., R)."""
    spread = spread_of(deviation_mm, "effective diameter")
    return (
        DIAMETER.of(deviation_mm.mean(axis=-1)),
        DIAMETER_WORST.of(worst_of(deviation_mm)),
        DIAMETER_SPREAD.of(spread),
    )


def single_point(points_mm: ArrayLike) -> tuple[Figure, Figure]:
    """(..., N, 3) touches of one seat → largest deviation and 2·S, each (...,). Raises UlnaInputError for one touch."""
    points = points_of(points_mm, 2, "single-point articulation")
    count = points.shape[-2]
    if count < 2:
        raise UlnaInputError(f"single-point articulation: {count} touch; expected 2 at the least. Take more.")
    delta_mm = np.linalg.norm(points - points.mean(axis=-2, keepdims=True), axis=-1)
    return SPAT_MAX.of(delta_mm.max(axis=-1)), SPAT_2S.of(2.0 * np.sqrt((delta_mm**2).sum(axis=-1) / (count - 1)))


def volumetric(deviation_mm: ArrayLike) -> tuple[Figure, Figure, Figure, Figure]:
    """(..., n) deviations of ball-bar lengths from the calibrated ones → the largest, 2 standard deviations, half the
    range, 2·RMS, each (...,). Raises UlnaInputError for a single length."""
    e = np.asarray(deviation_mm, dtype=np.float64)
    return (
        VOLUMETRIC_MAX.of(worst_of(e)),
        VOLUMETRIC_2S.of(2.0 * spread_of(e, "volumetric")),
        VOLUMETRIC_HALF_RANGE.of(0.5 * (e.max(axis=-1) - e.min(axis=-1))),
        VOLUMETRIC_2RMS.of(2.0 * np.sqrt((e**2).mean(axis=-1))),
    )


def worst_of(deviation_mm: F64) -> F64:
    """(..., n) → (...,): the one of the largest size, with its sign."""
    at = np.abs(deviation_mm).argmax(axis=-1)
    return np.asarray(np.take_along_axis(deviation_mm, at[..., None], axis=-1)[..., 0])
