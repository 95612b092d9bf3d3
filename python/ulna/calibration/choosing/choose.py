"""Choose a model by readings left out.

Every model of `ulna.calibration.choosing.models` is fitted without each group of readings in turn, and judged on it by
the figure that a metrologist reads. Among those that err by no more than one standard error of the difference more than
the best one, that with the fewest parameters is chosen (Breiman and others 1984): never one that errs more than
geometry alone.

How long it may take is told in multiplications and not in seconds, so that the choice is the same on every machine.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.calibration.choosing.groups import Groups, groups_of, thinned
from ulna.calibration.choosing.models import HARMONICS, LADDER, Model, allowed, asking, models_of
from ulna.calibration.choosing.rows import Rows, rows_of
from ulna.calibration.choosing.tried import ChosenModel, Ended, TriedModel
from ulna.calibration.choosing.widths import Known, falling, known_of
from ulna.calibration.extras import SCORES
from ulna.calibration.figures import overall_figures
from ulna.calibration.placements import Figures
from ulna.ground.arrays import F64, Progress
from ulna.study.assembly import Assembled, assemble
from ulna.study.data import FitOptions, Prior
from ulna.study.parameters import names_like
from ulna.study.study import Study

BUDGET = 6e10
"""Multiplications that the search may take: some ten seconds of one core."""
EIGEN = 10.0
"""Of a matrix with n rows, n³ times this: its axes."""
OF_FIGURES = 4e6
"""Making an arm and reading its figures, in multiplications."""


@dataclass(frozen=True)
class Choice:
    """What was chosen."""

    study: Study
    """With it."""
    model: ChosenModel
    start: dict[str, float]
    """Parameters by name from which its fit may start; empty where nothing was chosen."""


@dataclass(frozen=True)
class _Tried:
    model: Model
    known: Known
    errors: list[Figures]
    """Of each group left out."""
    seconds: float


def choose(study: Study, progress: Progress | None = None) -> Choice:
    """The study with the model chosen; its own where nothing else can be judged. Raises UlnaInputError."""
    began = time.perf_counter()
    few = thinned(study)
    groups = groups_of(few)
    blocks, impossible = allowed(few)
    if groups is None:
        ended = ChosenModel([], [], "too-few", "", 0, "", time.perf_counter() - began, impossible=impossible)
        return Choice(asking(study, [], [1]), ended, {})
    rows = rows_of(groups, blocks, range(1, LADDER[-1] + 1))
    stated = _states_harmonics(study, rows)
    models = sorted(models_of(blocks, LADDER[-1], stated), key=lambda model: len(rows.which(model.blocks, model.order)))
    tried, left = _all(groups, rows, models, progress)
    figure, errors = _errors(tried)
    if not figure:
        ended = ChosenModel([], [], "too-few", groups.by, groups.count, "", time.perf_counter() - began)
        return Choice(asking(study, [], [1]), dataclasses.replace(ended, impossible=impossible), {})
    best, kept = chosen(errors, [len(each.known.which) for each in tried])
    ended_by: Ended = "budget" if left else "all-tried"
    found, model = tried[kept], tried[kept].model
    told = ChosenModel(
        extras=model.extras,
        harmonics=list(range(1, model.order + 1)),
        ended=ended_by,
        by=groups.by,
        groups=errors.shape[1],
        figure=figure,
        seconds=time.perf_counter() - began,
        drawn_length_mm=rows.drawn_u["joint.*.d"] if model.extras else None,
        drawn_angle_rad=rows.drawn_u["joint.*.alpha"] if model.extras else None,
        tried=[_row(rows, each, errors[k], errors[best], k == kept) for k, each in enumerate(tried)],
        untried=left,
        impossible=impossible,
    )
    return Choice(_study(study, rows, found), told, _start(rows, found) if model.extras else {})


def start_of(choice: Choice, assembled: Assembled) -> F64 | None:
    """Parameters from which the fit of what was chosen starts; None: from the arm file's."""
    study = choice.study
    if not choice.start or study.fit.start != "given" or study.arm.unknown_signs.any():
        return None
    start = assembled.problem.parameters.tolist()
    return np.array([choice.start.get(name, value) for name, value in zip(assembled.names, start, strict=True)])


def chosen(errors: F64, parameters: Sequence[int]) -> tuple[int, int]:
    """Which of the models has the smallest error, and which is chosen. errors (models, groups), mm; geometry alone
    first."""
    mean = errors.mean(axis=1)
    best = int(np.argmin(mean))
    worse = errors - errors[best]
    u = worse.std(axis=1, ddof=1) / np.sqrt(errors.shape[1])
    good = np.flatnonzero((worse.mean(axis=1) <= u) & (mean <= mean[0])).tolist()
    return best, min(good, key=lambda k: (parameters[k], float(mean[k])))


def _all(groups: Groups, rows: Rows, models: list[Model], progress: Progress | None) -> tuple[list[_Tried], int]:
    """Each model in turn, as far as the budget goes; and how many are left."""
    spent, found = 0.0, list[_Tried]()
    held = [_rows_left_out(groups, group) for group in range(groups.count)]
    for number, model in enumerate(models):
        size = float(len(rows.which(model.blocks, model.order)))
        spent += EIGEN * size**3 + groups.count * (size**3 / 3.0 + OF_FIGURES)
        if found and spent > BUDGET:
            return found, len(models) - number
        if progress is not None:
            progress("choosing a model", number, len(models))
        found.append(_try(rows, model, held))
    return found, 0


def _try(rows: Rows, model: Model, held: list[Study]) -> _Tried:
    began = time.perf_counter()
    known = known_of(rows, model)
    errors = []
    for group, readings in enumerate(held):
        gram, _ = rows.without(group)
        step = rows.solved(known.which, known.u, known.variance, gram)
        errors.append(overall_figures(_arm(rows, known, step), readings))
    return _Tried(model, known, errors, time.perf_counter() - began)


def _arm(rows: Rows, known: Known, step: F64) -> Arm:
    return rows.arm_of(rows.parameters(known.which, step))


def _rows_left_out(groups: Groups, group: int) -> Study:
    return groups.study.subset([code == group for code in groups.codes])


def _errors(tried: list[_Tried]) -> tuple[str, F64]:
    """The figure that at least two groups give of every model, and its values (models, groups); "" where none is."""
    for figure in SCORES:
        given = [k for k in range(len(tried[0].errors)) if all(figure in each.errors[k] for each in tried)]
        if len(given) > 1:
            return figure, np.array([[each.errors[k][figure] for k in given] for each in tried])
    return "", np.zeros((len(tried), 0))


def _row(rows: Rows, tried: _Tried, errors: F64, best: F64, kept: bool) -> TriedModel:
    model, worse, root = tried.model, errors - best, np.sqrt(len(errors))
    return TriedModel(
        extras=model.extras,
        order=model.order or None,
        parameters=sum(rows.extra[k] != "" for k in tried.known.which),
        prior_u_rad=tried.known.first_rad,
        fall=None if model.width is None else model.width.fall,
        error_mm=float(errors.mean()),
        u_mm=float(errors.std(ddof=1) / root),
        worse_by_mm=float(worse.mean()),
        u_worse_by_mm=float(worse.std(ddof=1) / root),
        kept=kept,
        seconds=round(tried.seconds, 6),
    )


def _study(study: Study, rows: Rows, tried: _Tried) -> Study:
    """With the blocks, and with what is known beforehand where the study does not state it."""
    model = tried.model
    if not model.extras:
        return asking(study, [], [1])
    found = asking(study, model.extras, range(1, model.order + 1) if model.order else [1])
    names = assemble(found).names
    known: dict[str, Prior] = {}
    for pattern, u in rows.drawn_u.items():
        if names_like(pattern, names):
            known[pattern] = Prior(u)
    if model.width is not None and model.width.learned and tried.known.first_rad is not None:
        orders = np.arange(1, model.order + 1)
        for order, shape in zip(orders.tolist(), falling(model.width, orders).tolist(), strict=True):
            known[f"joint.*.[cs]{order}"] = Prior(tried.known.first_rad * shape)
    fit: FitOptions = dataclasses.replace(found.fit, prior=known | found.fit.prior, judge_extras=False)
    return dataclasses.replace(found, fit=fit)


def _start(rows: Rows, tried: _Tried) -> dict[str, float]:
    gram, _ = rows.without(None)
    step = rows.solved(tried.known.which, tried.known.u, tried.known.variance, gram)
    values = rows.parameters(tried.known.which, step)[rows.free[tried.known.which]]
    return dict(zip((rows.names[k] for k in tried.known.which), values.tolist(), strict=True))


def _states_harmonics(study: Study, rows: Rows) -> bool:
    """Whether the study says itself how large amplitudes of harmonics are."""
    names = [name for name, extra in zip(rows.names, rows.extra, strict=True) if extra == HARMONICS]
    return any(names_like(pattern, names) for pattern in study.fit.prior)
