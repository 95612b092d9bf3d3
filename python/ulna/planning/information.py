"""What measurements tell of the parameters: whitened rows with the placement eliminated, and coordinates for them.

A measurement's touches have residuals W (p(q) - (R f + t)) with WᵀW = Σ⁻¹, Σ = J_q Σ_encoder J_qᵀ + σ_seat² I. The
part of their derivatives that no placement explains, Q₂ᵀ W J with Q₂ orthogonal to the placement's own columns, is what
is left for the parameters: one row for a bar touched once at each end, that of its length.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.calibration.observability import indices
from ulna.geometry.rigid import turned
from ulna.ground.arrays import F64, I64
from ulna.planning.candidates import Candidates
from ulna.planning.spec import PlanSpec
from ulna.planning.touchable import touchable
from ulna.study.study import Study

RANK_TOLERANCE = 1e-9
"""Singular values below this part of the largest are zero, as in the core."""
VANISHED = 1e-10
"""Ten decades below its natural size a column is rounding, as in the core."""
_BLOCK = 5_000


def whitened(arm: Arm, q_rad: F64, probe: int, free: I64, encoder_rad: F64, seat_mm: float) -> tuple[F64, F64]:
    """(M, n) poses → W J (M, 3, free) and W (M, 3, 3)."""
    q_rad = np.ascontiguousarray(q_rad)
    by_encoder = arm.core.encoder_jacobian(q_rad, probe) * encoder_rad
    covariance = by_encoder @ by_encoder.transpose(0, 2, 1) + seat_mm**2 * np.eye(3)
    w = np.linalg.inv(np.linalg.cholesky(covariance))
    return w @ arm.core.jacobian(q_rad, probe)[:, :, free], w


def reduced(wj: F64, w: F64, features_mm: F64, free_frame: bool) -> F64:
    """(B, T, 3, p), (B, T, 3, 3) of T touches, at (B, T, 3) → (B, 3T - e, p): without what the e unknowns of the
    placement explain (3, 5 or 6)."""
    count, touches, _, p = wj.shape
    rows = wj.reshape(count, 3 * touches, p)
    if not free_frame:
        return rows
    arms = features_mm - features_mm.mean(axis=1, keepdims=True)
    _, size, axes = np.linalg.svd(arms, full_matrices=True)
    seen = size > 1e-8 * size.max(axis=1, keepdims=True) * (size.max(axis=1, keepdims=True) > 1e-9)
    span = int(seen[0].sum())
    # the line of a bar is the one axis about which a turn moves none of its seats
    turning = axes[:, 1:] if span == 1 else axes[:, : 3 if span else 0]
    translations = np.broadcast_to(np.eye(3), (count, touches, 3, 3))
    rotations = np.cross(turning[:, None], arms[:, :, None]).transpose(0, 1, 3, 2)
    return without((w @ np.concatenate([translations, rotations], axis=3)).reshape(count, 3 * touches, -1), rows)


def without(own: F64, rows: F64) -> F64:
    """(B, T, e), (B, T, p) → (B, T - e, p): the part of the rows that no combination of the e columns explains."""
    unknowns = own.shape[2]
    own = own / np.linalg.norm(own, axis=1, keepdims=True)
    q = np.linalg.qr(own, mode="complete").Q[:, :, unknowns:]
    left: F64 = q.transpose(0, 2, 1) @ rows
    return left


def candidate_rows(spec: PlanSpec, arm: Arm, probe: int, free: I64, candidates: Candidates) -> F64:
    """(N, k, free) rows of every candidate."""
    places, features, postures, n = candidates.q_rad.shape
    what = touchable(spec, arm, probe)
    noise = (spec.encoder_rad, spec.seat_mm)
    wj, w = whitened(arm, candidates.q_rad.reshape(-1, n), probe, free, *noise)
    wj = wj.reshape(places, features, postures, 3, -1)
    w = w.reshape(places, features, postures, 3, 3)
    touches = candidates.picked.shape[2]
    k = np.arange(features)[None, :, None]
    on_surface = what.outward is not None
    if on_surface:
        assert what.outward is not None
        outward = turned(what.at_mm, candidates.features_mm, what.outward)[:, :, None, :, None]
        # the surface is seen along its normal alone: n J over the root of n Σ n, with Wᵀ W the inverse of Σ
        across = np.linalg.solve(w.swapaxes(3, 4), np.broadcast_to(outward, (*w.shape[:3], 3, 1)))
        sigma = np.linalg.norm(across, axis=3)
        wj = (np.linalg.solve(w, wj) * outward).sum(axis=3) / sigma
    parts = []
    for start in range(0, len(candidates), _BLOCK):
        place = candidates.place[start : start + _BLOCK]
        at = (place[:, None, None], k, candidates.picked[start : start + _BLOCK])
        if on_surface:
            own = what.unknowns / sigma[at][:, :, 0]
            parts.append(without(own, wj[at][:, :, 0]))
            continue
        points = np.repeat(candidates.features_mm[place], touches, axis=1)
        flat = (len(place), features * touches, 3)
        parts.append(reduced(wj[at].reshape(*flat, -1), w[at].reshape(*flat, 3), points, spec.artefact.frame == "free"))
    return np.concatenate(parts)


def taken_rows(spec: PlanSpec, study: Study, arm: Arm, free: I64) -> F64:
    """(R, free) rows of readings that were taken already, at the arm's numbers; noise as their study or else as the
    plan states it."""
    noise = study.noise
    encoder_rad = spec.encoder_rad if noise is None else np.zeros(arm.n)
    if noise is not None and noise.encoder_rad is not None:
        encoder_rad = noise.encoder_rad
    seat_mm = spec.seat_mm if noise is None else (noise.seat_mm or 0.0)
    parts = [np.zeros((0, len(free)))]
    for group in study.readings:
        features = np.array(list(group.artefact.features.values())).reshape(-1, 3)
        code = group.placement_code if group.artefact.frame == "free" else np.zeros(len(group), np.int64)
        for standing in range(int(code.max()) + 1 if group.p_rad is None else 0):
            rows = np.flatnonzero(code == standing)
            wj, w = _each_probe(arm, group.q_rad[rows], group.probe[rows], free, encoder_rad, seat_mm)
            # the placement's own columns are those at the tips: R f + t is where they are
            at = arm.core.tip(np.ascontiguousarray(group.q_rad[rows]), group.probe[rows])
            if len(np.unique(features[group.feature[rows]], axis=0)) == 1:
                at = np.broadcast_to(at.mean(axis=0), at.shape)
            elif np.linalg.matrix_rank(features - features.mean(axis=0), tol=1e-9) == 1:  # features in a line
                line = np.linalg.svd(at - at.mean(axis=0))[2][0]
                at = at.mean(axis=0) + ((at - at.mean(axis=0)) @ line)[:, None] * line
            parts.append(reduced(wj[None], w[None], at[None], group.artefact.frame == "free")[0])
        if group.p_rad is not None:
            first, w_first = _each_probe(arm, group.q_rad, group.probe, free, encoder_rad, seat_mm)
            second, w_second = _each_probe(arm, group.p_rad, group.probe, free, encoder_rad, seat_mm)
            at = np.stack(
                [arm.core.tip(np.ascontiguousarray(q), group.probe) for q in (group.q_rad, group.p_rad)], axis=1
            )
            both = reduced(np.stack([first, second], axis=1), np.stack([w_first, w_second], axis=1), at, True)
            parts.append(both.reshape(-1, len(free)))
    return np.concatenate(parts)


def _each_probe(arm: Arm, q_rad: F64, probe: I64, free: I64, encoder_rad: F64, seat_mm: float) -> tuple[F64, F64]:
    wj, w = np.empty((len(q_rad), 3, len(free))), np.empty((len(q_rad), 3, 3))
    for index in np.unique(probe).tolist():
        own = probe == index
        wj[own], w[own] = whitened(arm, q_rad[own], index, free, encoder_rad, seat_mm)
    return wj, w


@dataclass(frozen=True)
class Coordinates:
    """Coordinates y of what the candidates determine: x = `to_free` y, in which their mean information is the identity.

    From singular values of the rows with unit columns; columns that vanish and directions that no candidate sees (the
    base frame) are left out, so that an information matrix may be formed of what is left without losing digits.
    """

    to_free: F64
    """(free, r)"""
    to_scaled: F64
    """(free, r): each parameter in units of its column's norm over the candidates; 0 where that vanishes."""

    @classmethod
    def of(cls, rows: F64, natural: F64) -> Coordinates:
        """From rows (R, free); natural (free,): how far a unit of each parameter moves the tip at the most, mm."""
        r = np.linalg.qr(rows, mode="r")
        norms = np.linalg.norm(r, axis=0)
        there = np.flatnonzero(norms / natural > VANISHED * (norms / natural).max())
        _, size, axes = np.linalg.svd(np.asarray(r)[:, there] / norms[there])
        rank = int((size > RANK_TOLERANCE * size[0]).sum())
        scaled = np.zeros((rows.shape[1], rank))
        # a mean over the rows, so that information of so many rows is of about that size
        scaled[there] = axes[:rank].T / size[:rank] * np.sqrt(len(rows))
        to_free = np.zeros_like(scaled)
        to_free[there] = scaled[there] / norms[there, None]
        return cls(to_free, scaled / np.sqrt(len(rows)))

    @property
    def rank(self) -> int:
        """Directions that are determined."""
        return int(self.to_free.shape[1])


def observability(rows: F64, coordinates: Coordinates) -> dict[str, float]:
    """`indices` of a plan's rows (R, free), columns scaled by their norm over the candidates."""
    size = np.linalg.norm(coordinates.to_scaled, axis=0)
    return indices(np.linalg.svd(rows @ coordinates.to_free / size, compute_uv=False), len(rows))
