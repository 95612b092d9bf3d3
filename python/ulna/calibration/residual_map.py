"""A judge of the model: do residuals still follow the turn of a joint?

For each joint the residuals are turned into an error of its angle, and a Gaussian process over that angle
(scikit-learn) learns it from all groups of readings but one and predicts it there. The share of the squares of that
group's residuals which the prediction takes away is noise about zero where the model has all that the arm does. Where
it is more than its standard error over the groups, by Student's factor, a block is missing that follows that joint's
turn.

The noise of a reading is taken to be all of the residuals, so that the map errs on the side of finding nothing.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.calibration.choosing.groups import codes_of
from ulna.ground.arrays import F64, I64
from ulna.ground.quantiles import student
from ulna.study.assembly import conditions_of
from ulna.study.study import Study

if TYPE_CHECKING:
    import ulna._core as _core

STEP_RAD = 1e-5
MOST_READINGS = 800
"""Of more, some are drawn by the study's seed."""
CONFIDENCE = 0.95
"""One-sided; of n joints none is called by chance more often than that."""
LEAST = 0.01
"""A share that is less is no matter."""
STARTS = (0.1, 1.0)
"""Length scales from which the likeliest one is sought."""
SIZES = (1e-5, 1e3)
"""Bounds of the map's variance, in units of that of the noise."""
SHORTEST, LONGEST = 0.03, 3.0
"""Bounds of the length scale, chords of the unit circle: errors that repeat from some 40 times a turn to once."""


@dataclass(frozen=True)
class JointMap:
    """What a map over one joint's angle predicts of residuals that it has not seen."""

    joint: int
    """From 1."""
    share: float
    """Of their squares, mean over the groups; below zero: it makes them larger."""
    u_share: float
    """Standard error of that mean."""
    amplitude_rad: float
    """Root mean square of the error of the joint's angle that all readings together show, weighed by their levers."""
    scale: float
    """Length scale of the map, as chord of the unit circle: about the radians over which it changes."""
    follows: bool
    """Whether residuals follow this joint's turn."""


@dataclass(frozen=True)
class ResidualMap:
    """Whether residuals can still be predicted, and from which joints' turns."""

    by: str
    """What was left out together; "" where there were too few readings, or none of points, and nothing was judged."""
    groups: int
    readings: int
    joints: list[JointMap]
    """Those that turn."""

    @property
    def missing(self) -> list[int]:
        """Joints whose turn residuals follow, the one that explains most first."""
        found = [each for each in self.joints if each.follows]
        return [each.joint for each in sorted(found, key=lambda each: -each.share)]


@dataclass(frozen=True)
class _Seen:
    """Residuals of points: N readings, n joints."""

    q_rad: F64
    """(N, n)"""
    residual_mm: F64
    """(N, 3)"""
    lever_mm: F64
    """(N, n, 3) of the tip for each radian of each joint."""
    code: I64
    """(N,) group."""


def residual_map(study: Study, arm: Arm, fitted: _core.Fitted) -> ResidualMap:
    """Of a fit to the study that ended with that arm. Raises UlnaInputError."""
    found = codes_of(study)
    seen = None if found is None else _seen(study, arm, fitted, found[1])
    if found is None or seen is None or len(np.unique(seen.code)) < 2:
        return ResidualMap("", 0, 0, [])
    groups = np.unique(seen.code)
    noise = float(np.mean(seen.residual_mm**2))
    confidence = 1.0 - (1.0 - CONFIDENCE) / arm.n
    needed = float(student(len(groups) - 1, confidence))
    turning = np.flatnonzero(~arm.slides).tolist()
    joints = [_of_joint(seen, joint, groups, noise, needed) for joint in turning]
    return ResidualMap(found[0], len(groups), len(seen.q_rad), joints)


def _of_joint(seen: _Seen, joint: int, groups: I64, noise: float, needed: float) -> JointMap:
    lever, residual = seen.lever_mm[:, joint], seen.residual_mm
    squares = np.maximum((lever**2).sum(axis=1), 1e-12)
    error = (lever * residual).sum(axis=1) / squares
    unit = float(np.sqrt(noise / np.mean(squares))) or 1.0
    variance = noise / squares / unit**2
    circle = np.column_stack([np.cos(seen.q_rad[:, joint]), np.sin(seen.q_rad[:, joint])])
    kernel, whole = _learned(circle, error / unit, variance)
    shares = []
    for group in groups:
        out = seen.code == group
        predicted = unit * _predicted(kernel, (circle[~out], error[~out] / unit, variance[~out]), circle[out])
        left = residual[out] - lever[out] * predicted[:, None]
        shares.append(1.0 - float((left**2).sum() / max((residual[out] ** 2).sum(), 1e-300)))
    share, u = float(np.mean(shares)), float(np.std(shares, ddof=1) / np.sqrt(len(shares)))
    amplitude = unit * float(np.sqrt(np.average(whole**2, weights=squares)))
    scale = float(kernel.k2.length_scale)
    return JointMap(joint + 1, share, u, amplitude, scale, share > max(LEAST, needed * u))


def _learned(circle: F64, error: F64, variance: F64) -> tuple[Any, F64]:
    """The likeliest kernel for points (N, 2) of the unit circle, and what its map says there; variance (N,) of each."""
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel

    best = None
    for start in STARTS:
        kernel = ConstantKernel(0.1, SIZES) * RBF(start, (SHORTEST, LONGEST))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a size at its bound: nothing is there
            found = GaussianProcessRegressor(kernel, alpha=variance).fit(circle, error)
        if best is None or found.log_marginal_likelihood_value_ > best.log_marginal_likelihood_value_:
            best = found
    assert best is not None
    return best.kernel_, best.predict(circle)


def _predicted(kernel: Any, known: tuple[F64, F64, F64], circle: F64) -> F64:
    """(M,) what a map that knows points, values and their variances says elsewhere, its kernel given."""
    from sklearn.gaussian_process import GaussianProcessRegressor

    points, values, variance = known
    found: F64 = GaussianProcessRegressor(kernel, alpha=variance, optimizer=None).fit(points, values).predict(circle)
    return found


def _seen(study: Study, arm: Arm, fitted: _core.Fitted, codes: list[I64]) -> _Seen | None:
    """Of touches whose residuals are points; None where there are none."""
    parts = []
    for number, (readings, code) in enumerate(zip(study.readings, codes, strict=True)):
        residual = fitted.residuals(number)
        # an orientation has three numbers too, and none of them is of the tip
        if residual.shape[1] != 3 or kind_of(readings.artefact).turned:
            continue
        said = conditions_of(study, arm, readings)[0]
        q = np.ascontiguousarray(readings.q_rad)
        lever = np.empty((*q.shape, 3))
        for joint in range(q.shape[1]):
            step = np.zeros_like(q)
            step[:, joint] = STEP_RAD
            ahead, behind = (arm.core.tip(q + sign * step, readings.probe, **said) for sign in (1.0, -1.0))
            lever[:, joint] = (ahead - behind) / (2.0 * STEP_RAD)
        parts.append((q, residual, lever, code))
    if not parts:
        return None
    q, residual, lever, code = (np.concatenate(each) for each in zip(*parts, strict=True))
    kept = np.sort(np.random.default_rng(study.fit.seed).permutation(len(q))[:MOST_READINGS])
    return _Seen(q[kept], residual[kept], lever[kept], code[kept])
