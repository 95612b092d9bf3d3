"""Performance tests on arms that are not quite as drawn, many at once: linear in what is wrong with them.

A test's poses are drawn with the arm as drawn; what the arm measures there differs by J δ from its parameters and by
the scatter of encoders and touch. δ is small where a figure agrees with a certificate, so that its square is nothing
beside the figure. Lengths mm, arrays (arms, …).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.geometry.sphere import fit_sphere
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.simulation.mover import Mover
from ulna.simulation.places import Standing, places
from ulna.uncertainties.performance import Figure, LengthTest, Performance, PointTest, SphereTest, Test
from ulna.verification.figures.asme_b89_4_22 import single_point, volumetric
from ulna.verification.figures.faro import half_ranges
from ulna.verification.figures.iso_10360_12 import probing_of

NEAR = 0.1
"""A seat's distance from the base, in parts of the reach, is as asked to within this."""
TRIED = 200
"""Seats tried before it is said that none can be touched."""


@dataclass(frozen=True)
class SetUp:
    """One test at poses of the arm as drawn."""

    test: Test
    tip_mm: F64
    """(N, 3) as drawn."""
    by_parameter: F64
    """(3 N, P)"""
    scatter: F64
    """(N, 3, 3) C: C z with z of unit variance is what encoders and touch add, as J_q Σ_q J_qᵀ + σ² I = C Cᵀ."""
    shape: tuple[int, ...]
    """Of the poses: (seats, touches), (bars, 2) or (balls, touches)."""

    def figures(self, off: F64, rng: np.random.Generator) -> dict[Figure, F64]:
        """Figure → (arms,) of arms off by (arms, P) from the drawing, read with noise."""
        count, poses = len(off), len(self.tip_mm)
        moved = (off @ self.by_parameter.T).reshape(count, poses, 3)
        moved += (rng.standard_normal((poses, count, 3)) @ self.scatter.swapaxes(1, 2)).swapaxes(0, 1)
        measured = (self.tip_mm + moved).reshape(count, *self.shape, 3)
        if isinstance(self.test, PointTest):
            return _of_points(measured)
        true = self.tip_mm.reshape(*self.shape, 3)
        return _of_lengths(measured, true) if isinstance(self.test, LengthTest) else _of_spheres(measured, true)


def _of_points(measured: F64) -> dict[Figure, F64]:
    """(A, seats, touches, 3)"""
    largest, two_s = (figure.value.max(axis=1) for figure in single_point(measured))
    half = np.max([figure.value for figure in half_ranges(measured)], axis=(0, 2))
    return {"largest": largest, "two_s": two_s, "half_range": half}


def _of_lengths(measured: F64, true: F64) -> dict[Figure, F64]:
    """(A, bars, 2, 3), (bars, 2, 3)"""
    error = _apart(measured) - _apart(true)
    largest, two_sigma, half, _ = volumetric(error)
    return {"largest": np.abs(largest.value), "two_sigma": two_sigma.value, "half_range": half.value}


def _apart(ends: F64) -> F64:
    """(..., 2, 3) → (...,)"""
    apart: F64 = np.linalg.norm(ends[..., 1, :] - ends[..., 0, :], axis=-1)
    return apart


def _of_spheres(measured: F64, true: F64) -> dict[Figure, F64]:
    """(A, balls, touches, 3), (balls, touches, 3)"""
    diameter_mm = 2.0 * fit_sphere(true, "ball").radius_mm
    size, form = (figure.value for figure in probing_of(fit_sphere(measured, "ball"), diameter_mm))
    return {"form": form.max(axis=1), "size": np.abs(size).max(axis=1)}


def set_up(arm: Arm, performance: Performance, mover: Mover, rng: np.random.Generator) -> list[SetUp]:
    """Every test once, somewhere in the volume. Raises UlnaInputError where the arm cannot take it."""
    probe = arm.probe_index(performance.probe)
    made = []
    for number, test in enumerate(performance.tests, 1):
        label = f"{performance.label}: test {number}"
        if isinstance(test, PointTest):
            q_rad = np.stack([_seat(mover, probe, part, test.touches, label, rng) for part in test.positions])
        elif isinstance(test, LengthTest):
            bars = []
            for length_mm in test.lengths_mm:
                ends_mm = np.array([[0.0, 0.0, 0.0], [length_mm, 0.0, 0.0]])
                _, poses = places(
                    Standing(ends_mm, f"{label}: length {length_mm:g} mm"), mover, probe, test.places, 1, rng
                )
                bars.append(poses[:, :, 0])
            q_rad = np.concatenate(bars)
        else:
            ball = Standing(_half_ball(test, rng), f"{label}: ball")
            _, poses = places(ball, mover, probe, test.positions, 1, rng)
            q_rad = poses[:, :, 0]
        flat = np.ascontiguousarray(q_rad.reshape(-1, arm.n))
        by_encoder = np.asarray(arm.core.encoder_jacobian(flat, probe) * performance.encoder_rad, dtype=np.float64)
        squared = by_encoder @ by_encoder.swapaxes(1, 2) + performance.seat_mm**2 * np.eye(3)
        scatter: F64 = np.asarray(np.linalg.cholesky(squared), dtype=np.float64)
        made.append(
            SetUp(
                test,
                arm.core.tip(flat, probe),
                arm.core.jacobian(flat, probe).reshape(3 * len(flat), -1),
                scatter,
                q_rad.shape[:2],
            )
        )
    return made


def _seat(mover: Mover, probe: int, part: float, touches: int, label: str, rng: np.random.Generator) -> F64:
    """(touches, n) postures on a seat so far from the base."""
    reach_mm = mover.arm.core.reach_mm(probe)
    at_mm = mover.arm.core.tip(mover.anywhere(50_000, rng), probe)
    distance = np.linalg.norm(at_mm, axis=1) / reach_mm
    for point in at_mm[np.abs(distance - part) < NEAR][:TRIED]:
        points = np.ascontiguousarray(np.tile(point, (touches, 1)))
        q_rad, reached = mover.on_points(points, np.full(touches, probe), {}, int(rng.integers(2**63)))
        if reached.all():
            return q_rad
    raise UlnaInputError(
        f"{label}: no seat was found at {part:g} of the reach that the arm touches in {touches} postures; expected "
        "one. Change positions, or widen the travel."
    )


def _half_ball(test: SphereTest, rng: np.random.Generator) -> F64:
    """(touches, 3) over one half, the ball's pole among them."""
    direction = rng.standard_normal((test.touches, 3))
    direction[:, 2] = np.abs(direction[:, 2])
    direction[0] = (0.0, 0.0, 1.0)
    points: F64 = 0.5 * test.diameter_mm * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return points
