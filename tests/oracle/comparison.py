"""The core's fit beside the oracle's: the same optimum, the same covariance."""

import numpy as np
import pytest

import ulna._core as _core

from . import fits
from .chain import Chain
from .core import core_problem
from .fits import Groups, Noise


def fitted_as_the_oracle(
    groups: Groups, start: Chain, hold: np.ndarray, noise: Noise | None
) -> tuple[_core.Fitted, fits.Found]:
    """What both find from a start, (k,) parameters held or not; checked: cost, parameters, covariance."""
    found = _core.fit(core_problem(start, groups, noise), hold)
    assert found.converged
    ours = start.with_parameters(found.parameters)
    # Weights belong to the arm that was found: the oracle is given the same.
    oracle = fits.fit(groups, ours, ~hold, noise, white_at=ours)
    covariance = oracle.covariance(stated=noise is not None)
    u = np.sqrt(np.diag(covariance))
    # The core widens each covariance by a millionth, so that one without seat noise can be inverted.
    assert found.cost == pytest.approx(oracle.cost, rel=3e-6)
    off = (ours.parameters - oracle.arm.parameters)[~hold] / u
    assert abs(off).max() < 1e-3  # in standard uncertainties
    # where the readings contradict the stated noise, the core scales by what they show
    scaled = found.covariance / (found.variance if noise is not None else 1.0) / np.outer(u, u)
    np.testing.assert_allclose(scaled, covariance / np.outer(u, u), rtol=0, atol=1e-4)
    return found, oracle
