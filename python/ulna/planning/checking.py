"""What was measured beside the plan: what is missing, what is far off, what the readings tell of the parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.planning.information import Coordinates, candidate_rows_of, taken_rows
from ulna.planning.planned import Planned
from ulna.planning.refusals import free_parameters
from ulna.planning.targets import Tests
from ulna.simulation.mover import Mover, travel_or_limits
from ulna.study.study import Study

FAR_MM, FAR_DEG = 100.0, 30.0
"""A touch is far from the plan where the tip, or some joint, is farther from it than this."""
NOTICED = 1.25
"""A parameter is known worse than promised where its standard uncertainty is so many times what the plan gives."""


@dataclass(frozen=True)
class FarTouch:
    """A touch that was measured otherwise than planned."""

    placement: str
    feature: str
    row: int
    """In its file, from 1."""
    off_mm: float
    """Of the tip, by the plan's arm."""
    off_deg: float
    """Of the joint that is farthest off."""
    joint: int


@dataclass(frozen=True)
class Known:
    """A parameter: its standard uncertainty in mm or rad, from the noise alone."""

    name: str
    unit: str
    promised: float
    now: float | None
    """None: the readings do not determine it."""


@dataclass(frozen=True)
class Checked:
    """What became of a plan."""

    planned: int
    """Placements."""
    missing: list[int]
    """Numbers of placements with a touch that was not measured."""
    other: list[str]
    """Placements of the artefact that the plan does not have."""
    touches: int
    """Measured ones that belong to a planned one."""
    far: list[FarTouch]
    """The farthest first."""
    promised_u_length_mm: float
    """Of test lengths, root mean square, as the plan's own postures give it."""
    u_length_mm: float | None
    """Of the same lengths as the readings give it; None where they leave something open that the plan determines."""
    determined: int
    """Directions of the parameters that the readings determine, of `to_determine`, those of the plan."""
    to_determine: int
    worse: list[Known]
    """Parameters that are known worse than promised by more than NOTICED, the worst first."""

    def as_dict(self) -> dict[str, Any]:
        """JSON types only, no NaN."""
        return {"format": "ulna-plan-check/1", **asdict(self)}


def check_study(planned: Planned, study: Study) -> Checked:
    """Readings of the plan's artefact are matched by their placement and feature; all readings of the study tell of the
    parameters, at the plan's arm. Raises UlnaInputError where the study is of something else."""
    name, arm = planned.spec.artefact.name, planned.arm
    group = next((each for each in study.readings if each.artefact.name == name), None)
    if group is None:
        raise UlnaInputError(
            f"{study.label}: has no readings of artefact '{name}', which {planned.path} plans; expected some. Name the "
            "study of what was measured."
        )
    if study.arm.parameter_names != arm.parameter_names:
        raise UlnaInputError(
            f"{study.label}: its arm '{study.arm.name}' has other parameters than '{arm.name}', for which "
            f"{planned.path} was made; expected the same joints and probes. Name another study."
        )
    labels = [str(each) for each in group.placement]
    count, places, often, _ = planned.q_rad.shape
    of = {str(number + 1): number for number in range(count)}
    if not set(labels) & set(of):
        raise UlnaInputError(
            f"{study.label}: placements of '{name}' are called {', '.join(sorted(set(labels))[:5])}; expected the "
            f"numbers of the plan's column placement, 1 to {count}. Number them so."
        )
    matched, wanted = _matched(labels, group.feature, of, places, often)
    got = np.bincount(wanted // (places * often), minlength=count)
    missing = (np.flatnonzero(got < places * often) + 1).tolist()
    far = _far(planned, group.q_rad[matched], wanted, matched, group.row)
    promised, now, known, rank, full = _known(planned, study, arm)
    return Checked(
        planned=count,
        missing=missing,
        other=sorted(set(labels) - set(of)),
        touches=len(matched),
        far=far,
        promised_u_length_mm=promised,
        u_length_mm=now,
        determined=rank,
        to_determine=full,
        worse=known,
    )


def _matched(labels: Sequence[str], feature: I64, of: dict[str, int], places: int, often: int) -> tuple[I64, I64]:
    """Rows of readings, and the planned touch of each: the k-th touch of a feature in a placement is the k-th planned;
    of a surface, rows in their order. More touches than planned are passed over."""
    seen: dict[tuple[int, int], int] = {}
    named = bool(feature.any()) or places == 1
    rows, wanted = [], []
    for row, label in enumerate(labels):
        if label not in of:
            continue
        number = of[label]
        place = int(feature[row]) if named else 0
        k = seen.get((number, place), 0)
        seen[number, place] = k + 1
        if k < (often if named else places * often):
            rows.append(row)
            wanted.append((number * places + place) * often + k)
    return np.array(rows, dtype=np.int64), np.array(wanted, dtype=np.int64)


def _far(planned: Planned, q_rad: F64, wanted: I64, matched: I64, row: I64) -> list[FarTouch]:
    arm, n = planned.arm, planned.arm.n
    _, places, often, _ = planned.q_rad.shape
    flat = planned.q_rad.reshape(-1, n)[wanted]
    tips = arm.core.tip(np.ascontiguousarray(q_rad), planned.probe)
    off_mm = np.linalg.norm(tips - np.repeat(planned.points_mm, often, axis=1).reshape(-1, 3)[wanted], axis=1)
    # a whole turn of a joint is the same posture
    off_deg = np.degrees(np.abs((q_rad - flat + np.pi) % (2.0 * np.pi) - np.pi))
    worst = off_deg.max(axis=1)
    names = list(planned.spec.artefact.features) or [str(k + 1) for k in range(places)]
    order = np.argsort(-np.maximum(off_mm / FAR_MM, worst / FAR_DEG))
    return [
        FarTouch(
            placement=str(wanted[k] // (places * often) + 1),
            feature=names[int(wanted[k] // often % places)],
            row=int(row[matched[k]]),
            off_mm=float(off_mm[k]),
            off_deg=float(worst[k]),
            joint=int(off_deg[k].argmax()) + 1,
        )
        for k in order.tolist()
        if off_mm[k] > FAR_MM or worst[k] > FAR_DEG
    ]


def _known(planned: Planned, study: Study, arm: Arm) -> tuple[float, float | None, list[Known], int, int]:
    """u(length) promised and now (mm), parameters known worse, determined directions now and by the plan."""
    spec, probe = planned.spec, planned.probe
    free = free_parameters(arm, spec)
    own = candidate_rows_of(spec, arm, probe, free, planned.q_rad).reshape(-1, len(free))
    taken = taken_rows(spec, study, arm, free)
    units = np.array(arm.parameter_units)[free]
    natural = np.where(units == "mm", 1.0, arm.core.reach_mm(probe))
    coordinates = Coordinates.of(own, natural)
    mover = Mover(arm, travel_or_limits(arm, spec.travel_rad, spec.label))
    tests = Tests.of(arm, spec, mover, probe, free, coordinates, np.random.default_rng([spec.seed, 47]))
    promised = _covariance(own @ coordinates.to_free)
    now = _covariance(taken @ coordinates.to_free)
    assert promised is not None  # the coordinates are those of the plan's own rows
    size = np.linalg.norm(coordinates.to_scaled, axis=1)
    names = np.array(arm.parameter_names)[free]
    before = np.sqrt(np.einsum("ij,jk,ik->i", coordinates.to_free, promised, coordinates.to_free))
    after = None if now is None else np.sqrt(np.einsum("ij,jk,ik->i", coordinates.to_free, now, coordinates.to_free))
    worse = [
        Known(str(names[k]), str(units[k]), float(before[k]), None if after is None else float(after[k]))
        for k in np.flatnonzero(size > 0.0).tolist()
        if after is not None and after[k] > NOTICED * before[k]
    ]
    worse.sort(key=lambda each: -(each.now or 0.0) / each.promised)
    rank = int(np.linalg.matrix_rank(taken @ coordinates.to_free, rtol=1e-6)) if len(taken) else 0
    return (
        _u_mm(tests.length_rows, promised),
        None if now is None else _u_mm(tests.length_rows, now),
        worse,
        rank,
        coordinates.rank,
    )


def _covariance(rows: F64) -> F64 | None:
    """(r, r) of readings with rows (R, r); None where they leave a direction open."""
    values, vectors = np.linalg.eigh(rows.T @ rows)
    if not len(rows) or values[0] <= 1e-9 * values[-1]:
        return None
    found: F64 = (vectors / values) @ vectors.T
    return found


def _u_mm(rows: F64, covariance: F64) -> float:
    return float(np.sqrt(np.einsum("ij,jk,ik->i", rows, covariance, rows).mean()))
