"""The difference of two calibrations over what both determine, against its joint covariance."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ulna.comparison.pair import Pair
from ulna.ground.arrays import F64
from ulna.ground.quantiles import chi_squared_beyond, fisher_beyond

#: of the largest singular value: what lengths see less of is a move of the base, or nothing
_SEEN = 1e-9
#: of directions of length 1: two calibrations lose nearly the same one, which is one
_ACROSS = 0.05
#: of the largest variance: a combination that both calibrations held
_HELD = 1e-13


@dataclass(frozen=True)
class Determined:
    """χ² of the difference, and each parameter's part in it."""

    chi2: float
    rank: int
    """Combinations of parameters that both determine."""
    p_value: float
    """How often a difference as large comes of the uncertainties alone."""
    lost: int
    """Combinations that one of them, or both, did not determine; left out."""
    delta: F64
    """(P,) the difference without what is left out, rad and mm."""
    u: F64
    """(P,) its standard uncertainty; 0 where both held it."""


def determined(pair: Pair, by_parameter: F64) -> Determined:
    """by_parameter: (K, P) derivatives of lengths, K more than P: what they do not see is a move of the base.

    χ² = zᵀ V⁻¹ z over the combinations z that both determine, V their covariance. Where the calibrations estimated
    their noise, V is a matrix times an estimated variance, and χ²/rank is distributed as F(rank, ν); ν is that of the
    calibration which rests on less.
    """
    scale = pair.scale
    _, sizes, rows = np.linalg.svd(by_parameter * scale, full_matrices=False)
    seen = rows[sizes > _SEEN * sizes[0]].T
    open_within = pair.lost @ seen
    kept = seen @ _complement(open_within)
    z = kept.T @ (pair.difference / scale)
    v = kept.T @ (pair.covariance / np.outer(scale, scale)) @ kept
    variances, axes = np.linalg.eigh(0.5 * (v + v.T))
    free = variances > _HELD * max(variances.max(initial=0.0), 1e-300)
    along = axes.T @ z
    chi2 = float((along[free] ** 2 / variances[free]).sum())
    rank = int(free.sum())
    return Determined(
        chi2,
        rank,
        _p_value(chi2, rank, pair.degrees_of_freedom),
        seen.shape[1] - kept.shape[1],
        scale * (kept @ z),
        scale * np.sqrt(np.maximum(np.einsum("pi,ij,pj->p", kept, v, kept), 0.0)),
    )


def _complement(rows: F64) -> F64:
    """(L, r) → (r, s) what is across all of them."""
    if not len(rows):
        return np.eye(rows.shape[1])
    _, sizes, across = np.linalg.svd(rows, full_matrices=True)
    rank = int((sizes > _ACROSS).sum())
    return np.asarray(across[rank:].T)


def _p_value(chi2: float, rank: int, freedom: float) -> float:
    if rank == 0:
        return 1.0
    if math.isinf(freedom):
        return chi_squared_beyond(rank, chi2)
    return fisher_beyond(rank, freedom, chi2 / rank)
