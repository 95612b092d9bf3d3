"""Whether an arm errs elsewhere as its readings scatter in one place.

What a model does not explain is alike for touches that are near each other: readings of one standing share it, so that
there are fewer independent errors than readings, and parameters are known less well than their scatter says. Readings
of one standing left out show it (of many standings those near each other, of a single one with very many features parts
of the volume). With rows J of a standing, what its placement explains taken off, residuals r of the
whole fit and H = J C Jᵀ (C of the parameters, for readings of unit variance), the fit to the others leaves
e = (I - H)⁻¹ r, and expects its covariance to be I + J C' Jᵀ = (I - H)⁻¹, C' without the standing. Along an eigenvector
of H with h < 1 the variance of e is then 1 + g² h / (1 - h), where g² is by what the parameters' covariance is too
small: the maximum of the likelihood of all standings says g², and its ratio to that of g = 1 whether chance does it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.covariance import root_of
from ulna.artefacts.artefact import features_mm
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.calibration.touched import touched
from ulna.geometry.rigid import fitted_motion
from ulna.ground.arrays import F64, I64, Bool
from ulna.study.assembly import Assembled, conditions_of
from ulna.study.study import Study

MOST_EQUATIONS = 60_000
"""Beyond, a standing more or less shows nothing."""
MOST_PLACES = 12
"""Standings that are left out one by one; of more those near each other together."""
REGIONS = 8
"""Parts of the volume into which the touches of a single standing are told, if they are many."""
LEAST_TOUCHES = 40
ROUNDS = 20
SHOWS = 0.3
"""An artefact's uncertainty above this part of the scatter shows."""
ALONE = 0.75
"""A direction of which a standing says more than this part is known from it alone: without it the others say next to
nothing, and how wrong that is tells nothing of the rest."""
SIGNIFICANT = 6.63
"""Twice the logarithm of the likelihoods' ratio that chance exceeds in one of a hundred."""


@dataclass(frozen=True)
class BetweenPlaces:
    """What readings of one standing say of a fit to the others."""

    places: int
    """Standings that have something to say."""
    factor: float
    """By what the parameters' uncertainties are larger than the scatter of the readings makes them; 1 where chance
    explains it."""


def between_places(study: Study, arm: Arm, assembled: Assembled, fitted: _core.Fitted) -> BetweenPlaces | None:
    """arm: the fitted one. None where there is one place, nothing was fitted or is known of the scatter, an artefact is
    less well known than that, or there are very many readings."""
    variance, covariance = fitted.variance, fitted.covariance
    if not covariance.size or not np.isfinite(covariance).all() or not variance > 0.0:
        return None
    if fitted.observations > MOST_EQUATIONS:
        return None
    if any(_uncertain(group, fitted, number) for number, group in enumerate(study.readings)):
        return None
    regions = _of_standings(study, arm, assembled, fitted) or _of_one_standing(study, arm, fitted)
    ratios, squares, places = [], [], 0
    for rows, residuals in regions or []:
        axes, sizes, _ = np.linalg.svd(rows, full_matrices=False)
        h = np.minimum(sizes**2, 1.0)
        told = (h < ALONE) & (h > 1e-12)
        places += bool(told.any())
        left = (axes.T @ residuals)[told] / (1.0 - h[told])
        ratios.append(h[told] / (1.0 - h[told]))
        squares.append(left**2 / variance)
    if places < 2:
        return None
    return BetweenPlaces(places, _factor(np.concatenate(ratios), np.concatenate(squares)))


def _uncertain(group: Readings, fitted: _core.Fitted, number: int) -> bool:
    """Whether what is not known of an artefact, and is not fitted, shows beside the scatter: it is the same in all
    places, and looks like an error of the arm."""
    artefact = group.artefact
    u_mm = max(artefact.u_mm, *(artefact.feature_u_mm or (0.0,)))
    scatter_mm = np.sqrt(fitted.variance) / float(np.median(fitted.weights(number)))
    return not artefact.fitted and u_mm > SHOWS * scatter_mm


Region = tuple[F64, F64]
"""Rows (R, k) whose products with their transposes are H, residuals (R,)."""


def _of_standings(study: Study, arm: Arm, assembled: Assembled, fitted: _core.Fitted) -> list[Region] | None:
    """Standings, of many those near each other together; None of fewer than two."""
    rows, residuals, standing = _core.rows_of_fit(assembled.problem, assembled.hold, fitted)
    at_mm, of_places = _where(study, arm)
    told = of_places[standing]
    rows, residuals, standing = rows[told], residuals[told], standing[told]
    if not len(standing) or standing[0] == standing[-1]:
        return None
    rows = rows @ root_of(fitted.covariance / fitted.variance)
    region = np.arange(len(at_mm))
    if len(at_mm) > MOST_PLACES:
        region = _regions(at_mm, MOST_PLACES)
    of_row = region[standing]
    return [(rows[of_row == number], residuals[of_row == number]) for number in np.unique(of_row)]


def _where(study: Study, arm: Arm) -> tuple[F64, Bool]:
    """(S, 3) mean tip of each standing, as the core counts them, and whether its readings tell places."""
    found, tell = [], []
    for group in study.readings:
        tips = arm.core.tip(
            np.ascontiguousarray(group.q_rad), np.ascontiguousarray(group.probe), **conditions_of(study, arm, group)[0]
        )
        if group.artefact.frame == "arm" or group.p_rad is not None:
            found.append(tips)
            tell.append(np.full(len(tips), not kind_of(group.artefact).turned))
            continue
        code, labels = group.labels.as_they_appear()
        counts = np.bincount(code, minlength=len(labels))[:, None]
        sums = np.stack([np.bincount(code, tips[:, k], minlength=len(labels)) for k in range(3)], axis=1)
        found.append(sums / counts)
        tell.append(np.full(len(labels), not kind_of(group.artefact).turned))
    return np.concatenate(found), np.concatenate(tell)


def _of_one_standing(study: Study, arm: Arm, fitted: _core.Fitted) -> list[Region] | None:
    """Parts of the volume, of a single standing with very many features: its motion is fitted to all of them. None of
    few touches, or of what is no set of features."""
    places = [number for number, each in enumerate(study.readings) if not kind_of(each.artefact).turned]
    if len(places) != 1:
        return None
    group = study.readings[places[0]]
    features = features_mm(group.artefact)
    if len(features) < LEAST_TOUCHES or len(group) < LEAST_TOUCHES:
        return None
    of_arm = [column for column in fitted.covariance_columns.tolist() if column < len(arm.parameter_names)]
    found = touched(arm, study, group, None)
    tips = found.tips_mm
    stood, moves = fitted_motion(tips, features[group.feature])
    weight = fitted.weights(places[0])[:, None]
    columns = (
        np.concatenate([found.by_parameter[:, :, of_arm], moves.reshape(len(group), 3, -1)], axis=2)
        * weight[:, :, None]
    )
    flat = columns.reshape(3 * len(group), -1)
    scale = np.linalg.norm(flat, axis=0)
    scale[scale == 0.0] = 1.0
    basis, sizes, _ = np.linalg.svd(flat / scale, full_matrices=False)
    rows = basis[:, sizes > 1e-9 * sizes[0]].reshape(len(group), 3, -1)
    residuals = (tips - stood) * weight
    region = _regions(tips, REGIONS)
    return [
        (rows[region == number].reshape(-1, rows.shape[2]), residuals[region == number].ravel())
        for number in np.unique(region)
    ]


def _regions(at_mm: F64, count: int) -> I64:
    """(N,) numbers of regions of points (N, 3): each nearest to its region's middle, begun far from each other."""
    middles = [at_mm[int(np.argmin(np.linalg.norm(at_mm - at_mm.mean(axis=0), axis=1)))]]
    apart = np.linalg.norm(at_mm - middles[0], axis=1)
    while len(middles) < count:
        middles.append(at_mm[int(np.argmax(apart))])
        apart = np.minimum(apart, np.linalg.norm(at_mm - middles[-1], axis=1))
    centres = np.array(middles)
    region = np.zeros(len(at_mm), dtype=np.int64)
    for _ in range(ROUNDS):
        region = np.argmin(((at_mm[:, None] - centres) ** 2).sum(axis=2), axis=1)
        centres = np.array(
            [at_mm[region == k].mean(axis=0) if (region == k).any() else centres[k] for k in range(count)]
        )
    return region


def _factor(ratio: F64, square: F64) -> float:
    """√ of the g² at which squares (N,) of variance 1 + g² ratio are likeliest; 1 where chance explains that."""

    def likelihood(g2: F64) -> F64:
        variance = 1.0 + g2[:, None] * ratio
        found: F64 = -(np.log(variance) + square / variance).sum(axis=1)
        return found

    low, high = 0.0, 2.0 * np.log(1e3)
    for _ in range(6):  # ever finer, about the largest
        tried = np.exp(np.linspace(low, high, 41))
        best = int(np.argmax(likelihood(tried)))
        low, high = np.log(tried[max(best - 1, 0)]), np.log(tried[min(best + 1, 40)])
    g2 = np.array([1.0, tried[best]])
    one, more = likelihood(g2)
    return float(np.sqrt(g2[1])) if more - one > SIGNIFICANT else 1.0
