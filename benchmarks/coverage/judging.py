"""What is judged of a calibration whose truth is known.

Each fitted parameter of which a u is stated; lengths of the fitted arm between random postures, by the parameters'
covariance; and lengths measured with new noise of encoders and touches, by all that `ulna.measure` states.
"""

import dataclasses
from fnmatch import fnmatchcase

import numpy as np

import ulna
from benchmarks.coverage.arms import Array
from benchmarks.coverage.cases import Case
from benchmarks.coverage.designs import Design
from benchmarks.coverage.statistics import coverage_factor

LENGTHS = 40
"""Of each calibration, of each kind."""

Counted = tuple[int, int, int]
"""Intervals that hold, intervals, values without one."""


def freedom(result: ulna.Result) -> float:
    """Degrees of freedom of what a calibration says is uncertain: infinite where the stated noise stands."""
    return result.noise.degrees_of_freedom


def factor(result: ulna.Result) -> float:
    """k of one number; NaN where there are no degrees of freedom."""
    return coverage_factor(freedom(result))


def counted(error: Array, u: Array, k: float) -> Counted:
    """errors (N,) and standard uncertainties (N,), NaN where there is none."""
    known = np.isfinite(u)
    inside = np.abs(error[known]) <= k * u[known]
    return int(inside.sum()), int(known.sum()), int((~known).sum())


def of_parameters(case: Case, here: Design, result: ulna.Result, rng: np.random.Generator) -> Counted:
    """Those that are fitted, the arm's own."""
    true = dict(zip(here.arm.parameter_names, here.arm.parameters.tolist(), strict=True))
    rows = [
        row
        for row in result.parameters
        if row.status != "held"
        and row.name in true
        and any(fnmatchcase(row.name, pattern) for pattern in case.parameters)
    ]
    error = np.array([row.value - true[row.name] for row in rows])
    return counted(error, np.array([np.nan if row.u is None else row.u for row in rows]), factor(result))


def of_lengths(case: Case, here: Design, result: ulna.Result, rng: np.random.Generator) -> Counted:
    """Between random postures of the fitted arm; what the parameters' covariance says of them."""
    readings = here.true.random(2 * LENGTHS, rng)
    q_rad, said = readings[:, : here.true.n], here.true.said(readings)
    at_mm, true_mm = result.arm.tip(q_rad, **said), here.true.tips.tip(readings)
    ends = np.arange(LENGTHS), np.arange(LENGTHS, 2 * LENGTHS)
    apart_mm = at_mm[ends[1]] - at_mm[ends[0]]
    length_mm = np.linalg.norm(apart_mm, axis=1)
    jacobian = result.arm.jacobian(q_rad, **said)
    along = np.einsum("ki,kip->kp", apart_mm / length_mm[:, None], jacobian[ends[1]] - jacobian[ends[0]])
    assert result.arm.uncertainty is not None
    covariance = result.arm.uncertainty.over(result.arm.parameter_names)
    u_mm = np.sqrt(np.maximum(np.einsum("kp,pq,kq->k", along, covariance, along), 0.0))
    stated_mm = ulna.measure(result, q_rad, **said).lengths(*ends)[1]
    assert stated_mm is not None
    u_mm[np.isnan(stated_mm)] = np.nan
    true_length_mm = np.linalg.norm(true_mm[ends[1]] - true_mm[ends[0]], axis=1)
    return counted(length_mm - true_length_mm, u_mm, factor(result))


def of_measured(case: Case, here: Design, result: ulna.Result, rng: np.random.Generator) -> Counted:
    """Between points that are touched, with the noise of touches and encoders."""
    readings = here.true.random(2 * LENGTHS, rng)
    # the point is where the tip is, but for what the touch misses it by
    touched_mm = here.true.tips.tip(readings) - dataclasses.replace(case.errors, missed=0.0).beside(len(readings), rng)
    q_rad = readings[:, : here.true.n] + case.errors.encoder_rad * rng.standard_normal((len(readings), here.true.n))
    said = {} if case.lacking else here.true.said(readings)
    ends = np.arange(LENGTHS), np.arange(LENGTHS, 2 * LENGTHS)
    value_mm, u_mm = ulna.measure(result, q_rad, **said).lengths(*ends)
    assert u_mm is not None
    true_mm = np.linalg.norm(touched_mm[ends[1]] - touched_mm[ends[0]], axis=1)
    return counted(value_mm - true_mm, u_mm, factor(result))


JUDGES = {"parameters": of_parameters, "lengths": of_lengths, "measured": of_measured}
"""By the columns of the table."""
