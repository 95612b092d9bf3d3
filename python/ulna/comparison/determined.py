"""The difference of two calibrations over what both determine, against its joint covariance."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ulna.comparison.pair import Pair
from ulna.comparison.poses import Lengths
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import chi_squared_beyond, fisher_beyond

#: of the largest singular value: what lengths see less of is a move of the base, or nothing
_SEEN = 1e-9
#: of directions of length 1: two calibrations lose nearly the same one, which is one
_ACROSS = 0.05
#: of the largest variance: a combination that both calibrations held
_HELD = 1e-13
#: of the largest variance: what rounding leaves of one that a shared artefact makes all of
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Determined:
    """The difference over combinations of parameters that both calibrations determine."""

    kept: F64
    """(P, r) the combinations, rad and mm."""
    z: F64
    """(r,) by how much each has changed."""
    covariance: F64
    """(r, r) of that."""
    chi2: float
    rank: int
    """Combinations of which χ² is: those that were not held by both."""
    p_value: float
    """How often a difference as large comes of the uncertainties alone."""
    lost: int
    """Combinations that one of them, or both, did not determine; left out."""

    @property
    def delta(self) -> F64:
        """(P,) the difference without what is left out, rad and mm."""
        return self.kept @ self.z

    @property
    def u(self) -> F64:
        """(P,) its standard uncertainty; 0 where both held it."""
        return self.u_of(self.kept)

    def u_of(self, by_kept: F64) -> F64:
        """(K, r) derivatives by the combinations → (K,) standard uncertainties."""
        variances = np.einsum("ki,ij,kj->k", by_kept, self.covariance, by_kept, optimize=True)
        return np.asarray(np.sqrt(np.maximum(variances, 0.0)))


def determined(pair: Pair, found: Lengths) -> Determined:
    """From lengths, more of them than parameters: what they do not see is a move of the base.

    The difference is that of the lengths, as the least change of parameters that makes it: zeros a whole turn apart, or
    another base, are the same arm. χ² = zᵀ V⁻¹ z over the combinations z that both determine, V their covariance. Where
    the calibrations estimated their noise, V is a matrix times an estimated variance, and χ²/rank is distributed as
    F(rank, ν); ν is that of the calibration which rests on less.

    Raises UlnaInputError where they cannot share an artefact as uncertain as is said.
    """
    scale = pair.scale
    left, sizes, rows = np.linalg.svd(found.by_parameter * scale, full_matrices=False)
    some = sizes > _SEEN * sizes[0]
    seen = rows[some].T
    across = _complement(pair.lost @ seen)
    kept = seen @ across
    z = across.T @ ((left[:, some].T @ found.change_mm) / sizes[some])
    v = _covariance(pair, kept / scale[:, None])
    variances, axes = np.linalg.eigh(v)
    free = variances > _HELD * max(variances.max(initial=0.0), 1e-300)
    along = axes.T @ z
    chi2 = float((along[free] ** 2 / variances[free]).sum())
    rank = int(free.sum())
    p_value = _p_value(chi2, rank, pair.degrees_of_freedom)
    return Determined(scale[:, None] * kept, z, v, chi2, rank, p_value, seen.shape[1] - kept.shape[1])


def _covariance(pair: Pair, by: F64) -> F64:
    """(r, r) of the difference over (P, r) combinations. An artefact of both is wrong for both: what its length does to
    all of an arm's lengths alike cancels, of what each calibration says of them."""
    one, other = (by.T @ matrix @ by for matrix in pair.covariances)
    grown, later = (pair.shared_u * (by.T @ lengths_mm) for lengths_mm in pair.lengths_mm)
    for mine, own, which in ((one, grown, pair.before), (other, later, pair.after)):
        if pair.shared_u and not _holds(mine, np.outer(own, own)):
            raise UlnaInputError(
                f"compare: shared u {pair.shared_u:g}: {which.label} knows its own lengths better than that; expected "
                "u over length of the artefact as its study states it (artefact u), 0 where it states none. Correct it."
            )
    common = np.outer(grown, later)
    return one + other - common - common.T


def _holds(whole: F64, part: F64) -> bool:
    """Whether what is left of a covariance without a part of it is one."""
    sizes = np.linalg.eigvalsh(whole - part)
    return not len(sizes) or bool(sizes[0] >= -_ROUNDING * sizes[-1])


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
