"""What measurements tell of the parameters: whitened rows with the placement eliminated, and coordinates for them.

The rows are the core's, those of which a fit is made: weighed for the noise, and without what any placement of the
artefact explains. A bar touched once at each end leaves one, that of its length.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.calibration.observability import indices
from ulna.ground.arrays import F64, I64
from ulna.planning.candidates import Candidates
from ulna.planning.measurements import as_certified, problem_of
from ulna.planning.spec import PlanSpec
from ulna.study.assembly import balls_mm, conditions_of
from ulna.study.study import Study

if TYPE_CHECKING:
    import ulna._core as _core

RANK_TOLERANCE = 1e-9
"""Singular values below this part of the largest are zero, as in the core."""
VANISHED = 1e-10
"""Ten decades below its natural size a column is rounding, as in the core."""
_BLOCK = 5_000


def candidate_rows(spec: PlanSpec, arm: Arm, probe: int, free: I64, candidates: Candidates) -> F64:
    """(N, k, free) rows of every candidate."""
    starts = range(0, len(candidates), _BLOCK)
    some = (np.arange(start, min(start + _BLOCK, len(candidates))) for start in starts)
    return np.concatenate([candidate_rows_of(spec, arm, probe, free, candidates.poses(each)) for each in some])


def candidate_rows_of(spec: PlanSpec, arm: Arm, probe: int, free: I64, q_rad: F64) -> F64:
    """(N, k, free) rows of measurements in (N, K, t, n) postures."""
    rows = _whitened(problem_of(arm, spec, probe, q_rad), free)
    # standing by standing, and each leaves as many
    return rows.reshape(len(q_rad), -1, len(free))


def taken_rows(spec: PlanSpec, study: Study, arm: Arm, free: I64) -> F64:
    """(R, free) rows of readings that were taken already, at the arm's numbers; noise as their study or else as the
    plan states it. Raises UlnaInputError where readings do not say what the arm's tip depends on."""
    import ulna._core as _core

    noise = study.noise
    if noise is None:
        problem = _core.Problem(arm.core, spec.encoder_rad, spec.seat_mm)
    else:
        problem = _core.Problem(arm.core, noise.encoder_rad, noise.seat_mm)
    for group in study.readings:
        balls, conditions = balls_mm(study, arm, group), conditions_of(study, arm, group)
        kind_of(group.artefact).enter(problem, as_certified(group), balls, conditions)
    return _whitened(problem, free) if study.readings else np.zeros((0, len(free)))


def _whitened(problem: _core.Problem, free: I64) -> F64:
    import ulna._core as _core

    hold = np.ones(len(problem.parameter_names), dtype=bool)
    hold[free] = False
    rows, _ = _core.whitened_rows(problem, hold)
    return rows


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
