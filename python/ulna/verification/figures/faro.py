"""What FARO's own software calls a single-point articulation test: another number than that of ASME B89.4.22.

For isotropic noise σ and ten touches it is about 1.5 σ an axis, where ASME's 2·S is about 3.4 σ.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from ulna.verification.figures.figure import Definition, Figure, points_of

STANDARD = "FARO's single-point articulation test"

SPAT_AXES = tuple(
    Definition(
        f"FARO SPAT, {axis}",
        f"FARO_SPAT_{axis}",
        f"(max {axis} - min {axis}) / 2 over the touches of one seat; it depends on the directions of the axes",
        STANDARD,
        signed=False,
    )
    for axis in "xyz"
)


def half_ranges(points_mm: ArrayLike) -> tuple[Figure, Figure, Figure]:
    """(..., N, 3) touches of one seat → (max - min)/2 of each coordinate, each (...,)."""
    points = points_of(points_mm, 2, "FARO's single-point articulation test")
    half = 0.5 * (points.max(axis=-2) - points.min(axis=-2))
    x, y, z = (definition.of(half[..., k]) for k, definition in enumerate(SPAT_AXES))
    return x, y, z
