"""What will be measured with the calibrated arm: test lengths and test points, and how they follow the parameters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64, I64
from ulna.planning.information import Coordinates
from ulna.planning.spec import PlanSpec
from ulna.simulation.mover import Mover
from ulna.simulation.places import Standing, places

LENGTHS = 500
"""Test bars in random places and directions, touched in random postures."""


@dataclass(frozen=True)
class Tests:
    """How what will be measured follows the parameters, in coordinates of `Coordinates`."""

    __test__ = False  # no test of pytest's

    q_rad: F64
    """(LENGTHS, 2, n) postures at the ends of the test bars."""
    length_rows: F64
    """(LENGTHS, r) ∂length/∂y, mm."""
    point_rows: F64
    """(6 LENGTHS, r) ∂p/∂y of both ends, mm, without what a rigid motion of all points explains."""

    @cached_property
    def point_square(self) -> F64:
        """(r, r) B with tr(C B) the mean variance of a coordinate, mm²."""
        square: F64 = self.point_rows.T @ self.point_rows / len(self.point_rows)
        return square

    @classmethod
    def of(
        cls,
        arm: Arm,
        spec: PlanSpec,
        mover: Mover,
        probe: int,
        free: I64,
        coordinates: Coordinates,
        rng: np.random.Generator,
    ) -> Tests:
        """Draw them. Raises UlnaInputError where the volume holds no such bar."""
        ends_mm = np.array([[0.0, 0.0, 0.0], [test_mm(arm, spec, probe), 0.0, 0.0]])
        # the test bars stand anywhere
        bar = Standing(ends_mm, f"{spec.label}: test bar", box_mm=spec.volume_mm)
        _, q_rad = places(bar, mover, probe, LENGTHS, 1, rng)
        poses = np.ascontiguousarray(q_rad[:, :, 0])
        flat = poses.reshape(-1, arm.n)
        p_mm = arm.core.tip(flat, probe)
        moved = arm.core.jacobian(flat, probe)[:, :, free] @ coordinates.to_free
        return cls(poses, length_rows(p_mm, moved), _points(p_mm, moved))


def test_mm(arm: Arm, spec: PlanSpec, probe: int) -> float:
    """Length of the test bars."""
    if spec.test_mm is not None:
        return spec.test_mm
    points = np.array(list(spec.artefact.features.values()) or [(0.0, 0.0, 0.0)])
    widest = float(np.linalg.norm(points[:, None] - points[None], axis=2).max())
    return widest if widest > 0.0 and spec.artefact.frame == "free" else 0.5 * arm.core.reach_mm(probe)


def length_rows(p_mm: F64, moved: F64) -> F64:
    """(N, F) how the lengths between each two of (2 N, 3) places follow what moves these, (2 N, 3, F)."""
    first, second = p_mm[0::2], p_mm[1::2]
    along = (second - first) / np.linalg.norm(second - first, axis=1, keepdims=True)
    rows: F64 = np.einsum("ni,nij->nj", along, moved[1::2] - moved[0::2])
    return rows


def _points(p_mm: F64, moved: F64) -> F64:
    about = p_mm - p_mm.mean(axis=0)
    turned = np.cross(np.eye(3)[None], about[:, None]).transpose(0, 2, 1)
    rigid = np.concatenate([np.broadcast_to(np.eye(3), (len(p_mm), 3, 3)), turned / np.abs(about).max()], axis=2)
    basis = np.linalg.qr(rigid.reshape(-1, 6)).Q
    rows = moved.reshape(len(p_mm) * 3, -1)
    left: F64 = rows - basis @ (basis.T @ rows)
    return left
