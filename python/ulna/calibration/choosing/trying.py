"""Trying models: each is fitted without each group of readings in turn, and judged on it.

How long it may take is told in multiplications and not in seconds, so that the choice is the same on every machine.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.calibration.choosing.groups import Groups
from ulna.calibration.choosing.models import Model, with_harmonics, without_harmonics
from ulna.calibration.choosing.rows import Rows, alone_without
from ulna.calibration.choosing.widths import Known, known_of
from ulna.calibration.extras import SCORES
from ulna.calibration.figures import overall_figures
from ulna.calibration.placements import Figures
from ulna.ground.arrays import F64, Progress

BUDGET = 6e10
"""Multiplications that the search may take: some ten seconds of one core."""
EIGEN = 10.0
"""Of a matrix with n rows, n³ times this: its axes."""
OF_FIGURES = 4e6
"""Making an arm and reading its figures, in multiplications."""


@dataclass(frozen=True)
class Tried:
    """One model, and its figures on what was left out."""

    model: Model
    known: Known
    errors: list[Figures]
    """Of each group left out."""
    seconds: float


def try_all(
    groups: Groups, rows: Rows, blocks: Sequence[str], stated: frozenset[str], progress: Progress | None
) -> tuple[list[Tried], int]:
    """Models without harmonics; then those with, lengths known as well as in the best one without. Geometry alone
    first, then by their parameters. And how many the budget left."""

    def size(model: Model) -> int:
        return len(rows.which(model.blocks, model.order))

    first = sorted(without_harmonics(blocks, stated), key=lambda model: (model.drawn, size(model)))
    later = sorted(with_harmonics(blocks, 1.0, stated), key=size)
    total, spent, found = len(first) + len(later), 0.0, list[Tried]()
    while len(found) < total:
        if len(found) == len(first):
            later = sorted(with_harmonics(blocks, _best_lengths(found), stated), key=size)
        model = (first + later)[len(found)]
        spent += EIGEN * size(model) ** 3 + groups.count * (size(model) ** 3 / 3.0 + OF_FIGURES)
        if found and spent > BUDGET:
            break
        if progress is not None:
            progress("choosing a model", len(found), total)
        found.append(_try(groups, rows, model))
    return found, total - len(found)


def errors_of(tried: Sequence[Tried]) -> tuple[str, F64]:
    """The figure that at least two groups give of every model, and its values (models, groups), mm; "" where none
    is."""
    for figure in SCORES:
        given = [k for k in range(len(tried[0].errors)) if all(figure in each.errors[k] for each in tried)]
        if len(given) > 1:
            return figure, np.array([[each.errors[k][figure] for k in given] for each in tried])
    return "", np.zeros((len(tried), 0))


def _best_lengths(tried: Sequence[Tried]) -> float:
    figure, errors = errors_of(tried)
    drawn = [k for k, each in enumerate(tried) if each.model.drawn]
    if not figure:
        return tried[drawn[0]].model.lengths
    with np.errstate(divide="ignore"):
        return tried[min(drawn, key=lambda k: float(np.log(errors[k]).mean()))].model.lengths


def _try(groups: Groups, rows: Rows, model: Model) -> Tried:
    began = time.perf_counter()
    known = known_of(rows, model)
    errors = []
    for group in range(groups.count):
        held = [code == group for code in groups.codes]
        if model.drawn:
            step = rows.solved(known.which, known.u, known.variance, rows.total - rows.grams[group])
            arm = rows.arm_of(rows.parameters(known.which, step))
        else:
            arm = alone_without(rows, groups.study.subset([~each for each in held]))
        errors.append(overall_figures(arm, groups.study.subset(held)))
    return Tried(model, known, errors, time.perf_counter() - began)
