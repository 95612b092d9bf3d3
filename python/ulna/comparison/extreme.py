"""Whether the largest of many changes is one that chance makes; χ² of all combinations is late to see one of them."""

from __future__ import annotations

import numpy as np

from ulna.arm.covariance import root_of
from ulna.ground.arrays import F64

DRAWS = 2000
_BLOCK = 250


def p_of_largest(by: F64, covariance: F64, largest: float, freedom: float, draws: int = DRAWS, seed: int = 0) -> float:
    """How often the largest of (K,) changes, each by its u, is at least `largest` where nothing has moved.

    by: (K, r) each change by its u, by what (r, r) covariance is of. By draws from a normal, or where freedom is finite
    from a multivariate t. Never below 1 / (draws + 1).
    """
    rng = np.random.default_rng(seed)
    root = by @ root_of(covariance)
    beyond = 0
    for first in range(0, draws, _BLOCK):
        count = min(_BLOCK, draws - first)
        drawn = np.abs(root @ rng.standard_normal((root.shape[1], count))).max(axis=0)
        if np.isfinite(freedom):
            drawn = drawn / np.sqrt(rng.chisquare(freedom, count) / freedom)
        beyond += int((drawn >= largest).sum())
    return (beyond + 1) / (draws + 1)
