"""Section 3 of the model: residuals of readings, with every placement an explicit unknown."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from .chain import Array, Chain

Index = NDArray[np.int64]


@dataclass(frozen=True)
class Lengths:
    """(N, n) poses, (N, n) partner poses, (N,) mm between their tips, (N,) or one probe."""

    q_rad: Array
    p_rad: Array
    length_mm: Array
    probe: int | Index = 0

    def unknowns(self, start: Chain) -> Array:
        return np.zeros(0)

    def residuals(self, arm: Chain, unknowns: Array) -> Array:
        between = arm.tip(self.q_rad, self.probe) - arm.tip(self.p_rad, self.probe)
        return np.linalg.norm(between, axis=1) - self.length_mm

    def jacobian(self, arm: Chain, unknowns: Array) -> tuple[Array, Array]:
        between = arm.tip(self.q_rad, self.probe) - arm.tip(self.p_rad, self.probe)
        along = between / np.linalg.norm(between, axis=1, keepdims=True)
        difference = arm.jacobian(self.q_rad, self.probe) - arm.jacobian(self.p_rad, self.probe)
        return np.einsum("ni,nik->nk", along, difference), np.zeros((len(along), 0))

    def covariance(self, arm: Chain, encoder_rad: Array, seat_mm: float) -> Array:
        """(N, 1, 1) of one length, mm²: both ends' encoders and touches, seen along the length."""
        tips = [arm.tip(x, self.probe) for x in (self.q_rad, self.p_rad)]
        along = (tips[0] - tips[1]) / np.linalg.norm(tips[0] - tips[1], axis=1, keepdims=True)
        out = np.full(len(along), 2 * seat_mm**2)
        for poses in (self.q_rad, self.p_rad):
            j = np.einsum("ni,nik->nk", along, arm.encoder_jacobian(poses, self.probe))
            out += (j**2 * encoder_rad**2).sum(axis=1)
        return out[:, None, None]


@dataclass(frozen=True)
class Points:
    """(F, 3) features touched in (N, n) poses: which feature (N,), in which placement (N,) 0, 1, ….

    ``placed``: False for coordinates in the base frame. A seat has one feature at the origin, a bar (0,0,0), (L,0,0).
    """

    features_mm: Array
    q_rad: Array
    feature: Index
    placement: Index
    probe: int | Index = 0
    placed: bool = True

    @property
    def seat(self) -> bool:
        return len(self.features_mm) == 1

    def unknowns(self, start: Chain) -> Array:
        """(placements * 3 or 6,): where each placement seems to stand by the start arm: shift, then turn vector."""
        if not self.placed:
            return np.zeros(0)
        tips = start.tip(self.q_rad, self.probe)
        rows = []
        for placement in range(self.placement.max() + 1):
            here = self.placement == placement
            seen, known = tips[here], self.features_mm[self.feature[here]]
            rows.append(seen.mean(axis=0) if self.seat else rigid_fit(known, seen))
        return np.concatenate(rows)

    def residuals(self, arm: Chain, unknowns: NDArray) -> NDArray:
        tips = arm.tip(self.q_rad, self.probe)
        return (tips - self._stands(unknowns)).ravel()

    def jacobian(self, arm: Chain, unknowns: Array) -> tuple[Array, Array]:
        of_arm = arm.jacobian(self.q_rad, self.probe).reshape(3 * len(self.q_rad), -1)
        columns = np.zeros((3 * len(self.q_rad), len(unknowns)))
        for k in range(len(unknowns)):
            moved = unknowns.astype(complex)
            moved[k] += 1e-30j
            columns[:, k] = -self._stands(moved).imag.ravel() / 1e-30
        return of_arm, columns

    def covariance(self, arm: Chain, encoder_rad: Array, seat_mm: float) -> Array:
        """(N, 3, 3) of a touch in the base frame, mm²."""
        j = arm.encoder_jacobian(self.q_rad, self.probe)
        return np.einsum("nik,k,njk->nij", j, encoder_rad**2, j) + seat_mm**2 * np.eye(3)

    def _stands(self, unknowns: NDArray) -> NDArray:
        """(N, 3): where the touched features stand in the base frame."""
        features = self.features_mm[self.feature]
        if not self.placed:
            return features
        if self.seat:
            return unknowns.reshape(-1, 3)[self.placement]
        pose = unknowns.reshape(-1, 6)[self.placement]
        return turned(pose[:, 3:], features) + pose[:, :3]


def turned(vectors: NDArray, points: NDArray) -> NDArray:
    """Rodrigues: (N, 3) points turned by (N, 3) turn vectors, rad; real or complex."""
    square = (vectors**2).sum(axis=1, keepdims=True)
    small = abs(square) < 1e-8
    angle = np.sqrt(np.where(small, 1.0, square))
    sine = np.where(small, 1 - square / 6 + square**2 / 120, np.sin(angle) / angle)
    cosine = np.where(small, 0.5 - square / 24 + square**2 / 720, (1 - np.cos(angle)) / np.where(small, 1.0, square))
    once = np.cross(vectors, points)
    return points + sine * once + cosine * np.cross(vectors, once)


def rigid_fit(known: Array, seen: Array) -> Array:
    """(6,) shift and turn vector that bring known points nearest to seen ones (Kabsch)."""
    centre_known, centre_seen = known.mean(axis=0), seen.mean(axis=0)
    u, _, vt = np.linalg.svd((seen - centre_seen).T @ (known - centre_known))
    handed = np.diag([1, 1, np.linalg.det(u @ vt)])
    turn = u @ handed @ vt
    return np.concatenate([centre_seen - turn @ centre_known, Rotation.from_matrix(turn).as_rotvec()])


def stack(groups: Sequence[Lengths | Points], arm: Chain) -> tuple[Array, list[slice]]:
    """Start values of all placements, and which part belongs to which group."""
    parts = [group.unknowns(arm) for group in groups]
    ends = np.cumsum([0, *(len(part) for part in parts)])
    return np.concatenate(parts), [slice(a, b) for a, b in pairwise(ends)]
