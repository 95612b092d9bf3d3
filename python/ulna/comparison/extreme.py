"""Whether the largest of many changes is one that chance makes; χ² of all combinations is late to see one of them."""

from __future__ import annotations

import numpy as np

from ulna.arm.covariance import root_of
from ulna.comparison.pair import Pair
from ulna.ground.arrays import F64

DRAWS = 2000
_BLOCK = 250


def p_of_largest(pair: Pair, by_parameter: F64, u_mm: F64, largest: float, draws: int = DRAWS, seed: int = 0) -> float:
    """How often the largest of (K,) changes, each by its u, is at least `largest` where nothing has moved.

    by_parameter: (K, P) derivatives. By draws of the difference from its covariance; with estimated noise from a
    multivariate t. Never below 1 / (draws + 1).
    """
    rng = np.random.default_rng(seed)
    root = (by_parameter @ root_of(pair.covariance)) / u_mm[:, None]
    beyond = 0
    for first in range(0, draws, _BLOCK):
        count = min(_BLOCK, draws - first)
        drawn = np.abs(root @ rng.standard_normal((root.shape[1], count))).max(axis=0)
        if np.isfinite(pair.degrees_of_freedom):
            freedom = pair.degrees_of_freedom
            drawn = drawn / np.sqrt(rng.chisquare(freedom, count) / freedom)
        beyond += int((drawn >= largest).sum())
    return (beyond + 1) / (draws + 1)
