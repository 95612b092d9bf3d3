"""Rigid motions: the best of one set of points onto another (Kabsch 1976, Acta Cryst. A32)."""

from __future__ import annotations

import numpy as np

from ulna.ground.arrays import F64, I64


def rotations(cross: F64) -> F64:
    """(S, 3, 3) of Σ b aᵀ → (S, 3, 3) the rotations R, never mirrors, for which Σ ‖b - R a‖² is least."""
    u, _, vt = np.linalg.svd(cross)
    u[:, :, 2] *= np.linalg.det(u @ vt)[:, np.newaxis]
    found: F64 = u @ vt
    return found


def placed(reference_mm: F64, measured_mm: F64, code: I64) -> F64:
    """(N, 3), (N, 3), (N,) numbers of sets: reference points after their set's best motion onto the measured ones."""
    counts = np.bincount(code)
    reference_mean, measured_mean = _means(reference_mm, code, counts), _means(measured_mm, code, counts)
    reference, measured = reference_mm - reference_mean[code], measured_mm - measured_mean[code]
    cross = np.empty((len(counts), 3, 3))
    for i in range(3):
        for j in range(3):
            cross[:, i, j] = np.bincount(code, measured[:, i] * reference[:, j], len(counts))
    found: F64 = np.einsum("nij,nj->ni", rotations(cross)[code], reference) + measured_mean[code]
    return found


def fitted_motion(tips: F64, at: F64) -> tuple[F64, F64]:
    """Where features (N, 3) stand that fit tips best, and an orthonormal basis (3N, k) of how they could have moved."""
    stood = placed(at, tips, np.zeros(len(at), dtype=np.int64))
    lever = stood - stood.mean(axis=0)
    by_turn = np.stack([np.cross(axis, lever) for axis in np.eye(3)], axis=2)
    by_shift = np.tile(np.eye(3), (len(at), 1, 1))
    size = float(np.abs(lever).max()) or 1.0
    columns = np.concatenate([by_shift, by_turn / size], axis=2).reshape(3 * len(at), 6)
    basis, sizes, _ = np.linalg.svd(columns, full_matrices=False)
    return stood, basis[:, sizes > 1e-9 * sizes[0]]


def turned(own: F64, placed_mm: F64, directions: F64) -> F64:
    """(K, 3) directions in the frame of (K, 3) points → (S, K, 3) where the points are (S, K, 3)."""
    middle = own - own.mean(axis=0)
    there = placed_mm - placed_mm.mean(axis=1, keepdims=True)
    found: F64 = directions @ rotations(np.einsum("skj,ki->sji", there, middle)).transpose(0, 2, 1)
    return found


def motions(own: F64, placed_mm: F64) -> tuple[F64, F64]:
    """(K, 3) points of a body and (S, K, 3) where they are → (S, 3) its origin and (S, 3, 3) its axes as rows: the best
    motions. What points on a line leave open is any."""
    middle = own.mean(axis=0)
    there = placed_mm.mean(axis=1)
    cross = np.einsum("skj,ki->sji", placed_mm - there[:, None], own - middle)
    axes = rotations(cross).transpose(0, 2, 1)
    origin: F64 = there - middle @ axes
    return origin, axes


def _means(values: F64, group: I64, counts: I64) -> F64:
    """(N, k) → (groups, k)."""
    return np.stack([np.bincount(group, column, len(counts)) for column in values.T], axis=1) / counts[:, np.newaxis]
