"""Choose a model by readings left out: every one of `ulna.calibration.choosing.models`, as far as a budget goes
(`trying`), by the figure that a metrologist reads, and by a rule that anybody can follow (`rule`).
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.arm.effects.effects import EFFECTS
from ulna.calibration.choosing.drawing import LENGTHS, alone_of
from ulna.calibration.choosing.groups import groups_of, thinned, whole
from ulna.calibration.choosing.models import HARMONICS, LADDER, Model, allowed, asking
from ulna.calibration.choosing.rows import Rows, rows_of
from ulna.calibration.choosing.rule import Compared, compared
from ulna.calibration.choosing.tried import ChosenModel, TriedModel
from ulna.calibration.choosing.trying import Tried, errors_of, try_all
from ulna.calibration.choosing.widths import Known, falling, known_of
from ulna.ground.arrays import F64, Progress
from ulna.study.assembly import Assembled
from ulna.study.data import FitOptions, Prior
from ulna.study.parameters import names_like
from ulna.study.study import Study


@dataclass(frozen=True)
class Choice:
    """What was chosen."""

    study: Study
    """With it."""
    model: ChosenModel
    start: dict[str, float]
    """Parameters by name from which its fit may start; empty where nothing was chosen."""


def choose(study: Study, progress: Progress | None = None) -> Choice:
    """The study with the model chosen; its own where nothing else can be judged. Raises UlnaInputError."""
    began = time.perf_counter()
    few = thinned(study)
    groups = groups_of(few)
    blocks, impossible = allowed(few)
    told = ChosenModel(
        [], [], False, "too-few", "" if groups is None else groups.by, 0 if groups is None else groups.count, "", 0.0
    )
    told.impossible.update(impossible)
    if groups is not None:
        near = alone_of(asking(few, [], [1]))
        rows = rows_of(groups, blocks, range(1, LADDER[-1] + 1), near)
        tried, left = try_all(groups, rows, blocks, _stated(study, rows, blocks), progress)
        figure, errors = errors_of(tried)
        if figure:
            beside = compared(errors, [len(each.model.extras) for each in tried])
            kept = tried[beside.chosen]
            model = kept.model
            told = dataclasses.replace(
                told,
                extras=model.extras,
                harmonics=list(range(1, model.order + 1)),
                drawn=model.drawn,
                ended="budget" if left else "all-tried",
                groups=errors.shape[1],
                figure=figure,
                seconds=time.perf_counter() - began,
                drawn_u=_drawn_u(rows, model),
                tried=[_row(rows, each, beside, k) for k, each in enumerate(tried)],
                untried=left,
            )
            # of the readings as they stand: what parts of a placement say of a width is less
            of_all = rows_of(whole(few), model.blocks, range(1, max(model.order, 1) + 1), near)
            known = known_of(of_all, model)
            return Choice(_study(study, of_all, model, known), told, _start(of_all, known) if model.drawn else {})
    return Choice(asking(study, [], [1]), dataclasses.replace(told, seconds=time.perf_counter() - began), {})


def start_of(choice: Choice, assembled: Assembled) -> F64 | None:
    """Parameters from which the fit of what was chosen starts; None: from the arm file's."""
    study = choice.study
    if not choice.start or study.fit.start != "given" or study.arm.unknown_signs.any():
        return None
    start = assembled.problem.parameters.tolist()
    return np.array([choice.start.get(name, value) for name, value in zip(assembled.names, start, strict=True)])


def _row(rows: Rows, tried: Tried, beside: Compared, number: int) -> TriedModel:
    model = tried.model
    return TriedModel(
        extras=model.extras,
        order=model.order or None,
        drawn=model.drawn,
        parameters=sum(rows.extra[k] != "" for k in tried.known.which),
        lengths_u_mm=_lengths_u_mm(rows, model),
        prior_u=tried.known.learned,
        fall=model.fall,
        error_mm=float(beside.error_mm[number]),
        worse_by=float(beside.worse[number]),
        u_worse_by=float(beside.u_worse[number]),
        kept=number == beside.chosen,
        seconds=round(tried.seconds, 6),
    )


def _lengths_u_mm(rows: Rows, model: Model) -> float | None:
    """Where the study does not state it."""
    if not model.drawn or not len(rows.lengths):
        return None
    return model.lengths * float(rows.before.u[rows.lengths].max())


def _drawn_u(rows: Rows, model: Model) -> dict[str, float]:
    if not model.drawn:
        return {}
    return {pattern: u * (model.lengths if pattern in LENGTHS else 1.0) for pattern, u in rows.drawn_u.items()}


def _study(study: Study, rows: Rows, model: Model, widths: Known) -> Study:
    """With the blocks, and with what is known beforehand where the study does not state it."""
    found = asking(study, model.extras, range(1, model.order + 1) if model.order else [1])
    known = {pattern: Prior(u) for pattern, u in _drawn_u(rows, model).items()}
    for block, u in widths.learned.items():
        if block == HARMONICS:
            orders = np.arange(1, model.order + 1)
            shape = falling(model.fall, orders).tolist()
            known |= {f"joint.*.[cs]{k}": Prior(u * part) for k, part in zip(orders.tolist(), shape, strict=True)}
        else:
            known |= dict.fromkeys(EFFECTS[block].patterns, Prior(u))
    fit: FitOptions = dataclasses.replace(found.fit, prior=known | found.fit.prior, judge_extras=False)
    return dataclasses.replace(found, fit=fit)


def _start(rows: Rows, known: Known) -> dict[str, float]:
    step = rows.solved(known.which, known.u, known.variance, rows.total)
    values = rows.parameters(known.which, step)[rows.free[known.which]]
    return dict(zip((rows.names[k] for k in known.which), values.tolist(), strict=True))


def _stated(study: Study, rows: Rows, blocks: Sequence[str]) -> frozenset[str]:
    """Blocks of which the study says itself what is known beforehand, and where an arm stands, of which nothing is."""
    found = {block for block in blocks if EFFECTS[block].of_first}
    for block in (HARMONICS, *blocks):
        names = [name for name, extra in zip(rows.names, rows.extra, strict=True) if extra == block]
        if any(names_like(pattern, names) for pattern in study.fit.prior):
            found.add(block)
    return frozenset(found)
