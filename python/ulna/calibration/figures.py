"""What a metrologist reads from touches: the figures of every placement, and of all of them together.

All of it comes from the tip positions alone, without the fit's own idea of where an artefact stands. What is read of
which kind of artefact, the kind says (`ulna.artefacts`); quantities: `ulna.artefacts.quantities`. Names end in the
unit; `_mean_abs_` is the mean of magnitudes, `_mean_` of a length error is the signed mean.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.arm.arm import Arm
from ulna.artefacts.kind import Errors, Tips
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.quantities import NAMES, QUANTITIES, Quantity
from ulna.artefacts.readings import Readings
from ulna.study.assembly import balls_mm, warmth_k
from ulna.study.study import Study

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Figures = dict[str, float]

LARGEST = [name for quantity in QUANTITIES if quantity.figures == ("largest",) for name in quantity.names()]
"""Figures that are one single error each."""


@dataclass(frozen=True)
class PlacementFigures:
    """The figures of one artefact in one placement."""

    artefact: str
    placement: str
    kind: str
    readings: int
    """Number of rows."""
    figures: Figures
    """Only those of `NAMES` that these readings give, mm."""

    def as_dict(self) -> dict[str, Any]:
        """As in `result.json` and `evaluation.json`, list `artefacts`."""
        return {
            "artefact": self.artefact,
            "placement": self.placement,
            "kind": self.kind,
            "readings": self.readings,
            **self.figures,
        }

    @classmethod
    def from_dict(cls, entry: Mapping[str, Any]) -> PlacementFigures:
        """The inverse of `as_dict`."""
        figures = {name: float(entry[name]) for name in NAMES if name in entry}
        return cls(entry["artefact"], entry["placement"], entry["kind"], entry["readings"], figures)


def figures(arm: Arm, study: Study) -> tuple[list[PlacementFigures], Figures]:
    """Per artefact and placement, and over all touches and lengths of all of them together.

    `arm` must carry the study's probes in the study's order. Errors: those of the core for wrong shapes.
    """
    entries: list[PlacementFigures] = []
    pooled: list[dict[str, Errors]] = []
    for readings in study.readings:
        # one probe for all is much quicker than one for each row
        probe = int(readings.probe[0]) if (readings.probe == readings.probe[0]).all() else readings.probe
        warmth = warmth_k(study, arm, readings)
        first_mm = arm.core.tip(np.ascontiguousarray(readings.q_rad), probe, warmth)
        second_mm = None
        if readings.p_rad is not None:
            second_mm = arm.core.tip(np.ascontiguousarray(readings.p_rad), probe, warmth)
        labels, code = placements(readings)
        tips = Tips(first_mm, second_mm, balls_mm(study, arm, readings)[readings.probe], code)
        errors = kind_of(readings.artefact).errors(readings, tips)
        pooled.append(errors)
        own = [quantity for quantity in QUANTITIES if quantity.name in errors]
        per_quantity = {quantity.name: _by_placement(quantity, errors[quantity.name], len(labels)) for quantity in own}
        counts = np.bincount(code, minlength=len(labels))
        for number, label in enumerate(labels):
            found = {name: value for quantity in per_quantity.values() for name, value in quantity[number].items()}
            entries.append(
                PlacementFigures(readings.artefact.name, label, readings.artefact.kind, int(counts[number]), found)
            )
    overall: Figures = {}
    for quantity in QUANTITIES:
        values = [errors[quantity.name].value_mm for errors in pooled if quantity.name in errors]
        if values:
            overall.update(_summaries(quantity, np.concatenate(values), np.zeros(1, dtype=np.int64))[0])
    return entries, overall


def placements(readings: Readings) -> tuple[list[str], I64]:
    """Labels of the placements in the order in which they appear, and (N,) the number of each row's placement."""
    code = readings.placement_code
    count = int(code.max()) + 1 if len(code) else 0
    first = np.full(count, len(code), dtype=np.int64)
    np.minimum.at(first, code, np.arange(len(code)))
    return [str(readings.placement[row]) for row in first], code


def _by_placement(quantity: Quantity, errors: Errors, count: int) -> list[Figures]:
    """The figures of each placement; {} where it has none."""
    found: list[Figures] = [{} for _ in range(count)]
    order = np.argsort(errors.code, kind="stable")
    present, start = np.unique(errors.code[order], return_index=True)
    for number, summary in zip(present, _summaries(quantity, errors.value_mm[order], start), strict=True):
        found[number] = summary
    return found


def _summaries(quantity: Quantity, values_mm: F64, start: I64) -> list[Figures]:
    """The figures of each run of values; a run begins at each of `start`."""
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
    columns = [of[figure]() for figure in quantity.figures]
    return [dict(zip(quantity.names(), row, strict=True)) for row in np.stack(columns, axis=1).tolist()]


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


def without_repeats(entries: Sequence[PlacementFigures], columns: Sequence[str]) -> list[str]:
    """Where every placement has one length, its signed error says all: the columns without the sizes of it."""
    mean, largest = "length_error_mean_abs_mm", "length_error_max_abs_mm"
    if all(entry.figures.get(mean) == entry.figures.get(largest) for entry in entries):
        return [name for name in columns if name not in (mean, largest)]
    return list(columns)
