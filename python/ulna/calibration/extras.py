"""Blocks beyond geometry, judged: each has to explain readings that it has not seen.

The fit always gets better with more parameters. So every block is left out once, and both models are fitted without
each group of readings in turn and compared on that group: the block has earned its place where the errors left out fall
by more than their own uncertainty (the standard error of the differences, group by group; of few groups more is asked,
by Student's factor). Of harmonics of several orders each is judged besides, as long as they are few.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ulna.arm.effects.effects import EFFECTS, Extra
from ulna.calibration.figures import overall_figures
from ulna.calibration.folds import Fold, folds
from ulna.calibration.placements import Figures
from ulna.calibration.running import run_fit
from ulna.ground.arrays import Progress
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import student
from ulna.study.assembly import assemble
from ulna.study.study import Study

Verdict = Literal["earned", "undecided", "not-earned"]

#: more placements than this are dealt into folds
MOST_GROUPS = 10
FOLDS = 5
#: one standard deviation of a normal distribution, one-sided: what a difference must exceed by Student's factor
CONFIDENCE = 0.8413

#: what a model is judged by: the first of these that the readings left out give
SCORES = (
    "seat_scatter_mean_mm",
    "coordinate_error_mean_mm",
    "length_error_mean_abs_mm",
    "form_mm",
)


@dataclass(frozen=True)
class JudgedExtra:
    """A block, and what it does for readings that the fit has not seen."""

    extra: Extra
    figure: str
    """Which figure it was judged by, mean over the groups left out."""
    without_mm: float
    """The figure of the model without the block."""
    with_mm: float
    """And with it, all else alike."""
    better_by_mm: float
    u_better_by_mm: float | None
    """Standard error of the difference, from the groups; None with fewer than two."""
    groups: int
    """How often readings were left out."""
    by: str
    """What was left out together."""
    verdict: Verdict
    order: int | None = None
    """Of harmonics of several orders: which of them; None: the whole block."""


def judge_extras(study: Study, progress: Progress | None = None) -> list[JudgedExtra]:
    """Every block of `study.fit.extras`. Empty where the readings cannot be told into groups. Raises UlnaInputError."""
    try:
        by, groups = _groups(study)
    except UlnaInputError:
        return []
    parts = _parts(study)
    told = _Told(progress, (1 + len(parts)) * len(groups))
    whole = [_left_out(study, fold, told) for fold in groups]
    judged = []
    for extra, order, patterns in parts:
        reduced = [_left_out(_without(study, patterns), fold, told) for fold in groups]
        found = compared(extra, order, reduced, whole, by)
        if found is not None:
            judged.append(found)
    return judged


def _parts(study: Study) -> list[tuple[str, int | None, tuple[str, ...]]]:
    """What is judged: each block, and of a few orders of harmonics each order; with patterns of its parameters."""
    fit = study.fit
    return [(extra, *part) for extra in fit.extras for part in EFFECTS[extra].judged(fit.harmonics)]


def _groups(study: Study) -> tuple[str, list[Fold]]:
    """Placements one by one where they are few, else folds of them; single readings where there is one placement."""
    try:
        by, groups = folds(study, "placement")
    except UlnaInputError:
        return folds(study, FOLDS)
    return (by, groups) if len(groups) <= MOST_GROUPS else folds(study, FOLDS)


def _without(study: Study, patterns: Sequence[str]) -> Study:
    """The study with a block, or a part of it, held as the arm file has it: at zero, usually."""
    hold = [*study.fit.hold, *patterns]
    return dataclasses.replace(study, fit=dataclasses.replace(study.fit, hold=hold))


class _Told:
    """Progress over all fits."""

    def __init__(self, progress: Progress | None, total: int) -> None:
        self._progress, self._total, self._done = progress, total, 0

    def __call__(self) -> None:
        self._done += 1
        if self._progress is not None:
            self._progress("judging extras", self._done, self._total)


def _left_out(study: Study, fold: Fold, told: _Told) -> Figures:
    training, test = study.subset([~mask for mask in fold.masks]), study.subset(fold.masks)
    assembled_arm = assemble(training).arm
    fitted = run_fit(training)
    arm = assembled_arm.with_signs(fitted.arm.signs)
    told()
    return overall_figures(arm.with_parameters(fitted.parameters[: len(arm.parameter_names)]), test)


def compared(
    extra: str, order: int | None, reduced: list[Figures], whole: list[Figures], by: str
) -> JudgedExtra | None:
    """Both models' figures on each group left out, as a verdict; None where no figure is in both."""
    for figure in SCORES:
        pairs = [(a[figure], b[figure]) for a, b in zip(reduced, whole, strict=True) if figure in a and figure in b]
        if pairs:
            break
    else:
        return None
    without_mm, with_mm = np.array(pairs).mean(axis=0).tolist()
    gains = np.array([a - b for a, b in pairs])
    better = float(gains.mean())
    u = float(gains.std(ddof=1) / np.sqrt(len(gains))) if len(gains) > 1 else None
    verdict: Verdict = "undecided"
    if u is not None and abs(better) > u * float(student(len(gains) - 1, CONFIDENCE)):
        verdict = "earned" if better > 0 else "not-earned"
    return JudgedExtra(extra, figure, without_mm, with_mm, better, u, len(pairs), by, verdict, order)
