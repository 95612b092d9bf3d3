"""What a metrologist reads from touches: the figures of every placement, and of all of them together.

All of it comes from the tip positions alone, without the fit's own idea of where an artefact stands. What is read of
which kind of artefact, the kind says (`ulna.artefacts`); quantities: `ulna.artefacts.quantities`. Names end in the
unit; `_mean_abs_` is the mean of magnitudes, `_mean_` of a length error is the signed mean.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.attitudes import attitudes
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.quantities import NAMES, QUANTITIES, Quantity
from ulna.artefacts.readings import Readings
from ulna.calibration.placements import Figures, Placements
from ulna.ground.arrays import F64, I64
from ulna.study.assembly import balls_mm, conditions_of
from ulna.study.study import Study

LARGEST = [name for quantity in QUANTITIES if quantity.figures == ("largest",) for name in quantity.names()]
"""Figures that are one single error each."""


@dataclass(frozen=True)
class GroupErrors:
    """The errors of one artefact's touches, by quantity, and its placements in the order in which they appear."""

    readings: Readings
    placements: list[str]
    code: I64
    """(N,) number of each row's placement."""
    errors: dict[str, Errors]


def figures(arm: Arm, study: Study) -> tuple[Placements, Figures]:
    """Per artefact and placement, and over all touches and lengths of all of them together.

    `arm` must carry the study's probes in the study's order. Errors: those of the core for wrong shapes.
    """
    groups = group_errors(arm, study)
    return by_placement(groups), over_all(groups)


def overall_figures(arm: Arm, study: Study) -> Figures:
    """The same over all of them together alone."""
    return over_all(group_errors(arm, study))


def group_errors(arm: Arm, study: Study) -> list[GroupErrors]:
    """The single errors of which figures are made, for each artefact."""
    return [_group(arm, study, readings) for readings in study.readings]


def _group(arm: Arm, study: Study, readings: Readings) -> GroupErrors:
    # one probe for all is much quicker than one for each row
    probe = int(readings.probe[0]) if (readings.probe == readings.probe[0]).all() else readings.probe
    conditions = conditions_of(study, arm, readings)
    first_mm = arm.core.tip(np.ascontiguousarray(readings.q_rad), probe, **conditions[0])
    second_mm = None
    if readings.p_rad is not None:
        second_mm = arm.core.tip(np.ascontiguousarray(readings.p_rad), probe, **conditions[1])
    code, labels = readings.labels.as_they_appear()
    kind = kind_of(readings.artefact)
    turned = attitudes(arm.core, np.ascontiguousarray(readings.q_rad), probe, conditions[0]) if kind.turned else None
    tips = Tips(first_mm, second_mm, balls_mm(study, arm, readings)[readings.probe], code, turned)
    return GroupErrors(readings, labels, code, kind.errors(readings, tips))


def over_all(groups: Sequence[GroupErrors]) -> Figures:
    """Over all touches and lengths together."""
    found: Figures = {}
    for quantity in QUANTITIES:
        values = [group.errors[quantity.name].value_mm for group in groups if quantity.name in group.errors]
        if values:
            columns = _summaries(quantity, np.concatenate(values), np.zeros(1, dtype=np.int64))
            found.update({name: float(column[0]) for name, column in columns.items()})
    return found


def by_placement(groups: Sequence[GroupErrors]) -> Placements:
    """Of each placement, in the order in which they appear."""
    return Placements.joined([_of_group(group) for group in groups])


def _of_group(group: GroupErrors) -> Placements:
    columns: dict[str, F64] = {}
    for quantity in QUANTITIES:
        if quantity.name not in group.errors:
            continue
        errors = group.errors[quantity.name]
        order = np.argsort(errors.code, kind="stable")
        present, start = np.unique(errors.code[order], return_index=True)
        for name, values in _summaries(quantity, errors.value_mm[order], start).items():
            columns[name] = np.full(len(group.placements), np.nan)
            columns[name][present] = values
    artefact, counts = group.readings.artefact, np.bincount(group.code, minlength=len(group.placements))
    return Placements.of_columns(artefact.name, artefact.kind, group.placements, counts, columns)


def _summaries(quantity: Quantity, values_mm: F64, start: I64) -> dict[str, F64]:
    """The figures of each run of values, by name; a run begins at each of `start`."""
    counts = np.diff(start, append=len(values_mm))
    size = np.abs(values_mm)
    signed = "mean_abs" in quantity.figures

    def mean(values: F64) -> F64:
        sums: F64 = np.add.reduceat(values, start)
        return sums / counts

    def largest() -> F64:
        at = [at + int(np.argmax(size[at : at + count])) for at, count in zip(start, counts, strict=True)]
        return values_mm[at]

    of: dict[str, Callable[[], F64]] = {
        "mean": lambda: mean(values_mm if signed else size),
        "mean_abs": lambda: mean(size),
        "rms": lambda: np.sqrt(mean(size**2)),
        "max": lambda: np.maximum.reduceat(size, start),
        "max_abs": lambda: np.maximum.reduceat(size, start),
        "largest": largest,
    }
    return dict(zip(quantity.names(), (of[figure]() for figure in quantity.figures), strict=True))


def over_groups(groups: Iterable[Figures]) -> Figures:
    """Over all groups of a cross-validation: means are means of the groups' means, every group weighing the same;
    rms is the root of the mean of their squares; max is the largest."""
    gathered: dict[str, Sequence[float]] = {}
    for group in groups:
        for name, value in group.items():
            gathered[name] = [*gathered.get(name, ()), value]
    found: Figures = {}
    for name in NAMES:
        if name not in gathered:
            continue
        values = np.array(gathered[name])
        if "_max_" in name or name in LARGEST:
            found[name] = float(values[np.argmax(np.abs(values))])
        elif "_rms_" in name:
            found[name] = float(np.sqrt(np.mean(values**2)))
        else:
            found[name] = float(values.mean())
    return found
