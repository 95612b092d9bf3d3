"""One figure against those of earlier checks: limits of a baseline, the average, rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.checking.history import Past
from ulna.checking.tables import ControlTable
from ulna.control.basis import Basis
from ulna.control.chart import Chart, chart
from ulna.control.runs import RULES
from ulna.ground.arrays import F64
from ulna.ground.worded import worded


@dataclass(frozen=True)
class Signal:
    """What is out of control."""

    rule: str
    words: str
    slow: bool
    """Whether several checks together show it, so that touching again will not help."""


@dataclass(frozen=True)
class History:
    """What the history of a figure says of it; mm."""

    basis: Basis
    earlier: int
    """Earlier checks that have it, the baseline's and those after it."""
    not_used: int
    """And those in which it was out by itself."""
    centre: float | None
    """Of the baseline; None where there are too few earlier checks, and then nothing below is known either."""
    lower: float | None
    """Of a single figure; of one that cannot be negative None: small ones are no fault."""
    upper: float | None
    average: float | None
    """Weighted, the latest figure the most."""
    average_lower: float | None
    average_upper: float | None
    signals: tuple[Signal, ...]
    notes: tuple[str, ...]
    """Figures in a row that a rule finds, in words, where the protocol does not count them."""

    @property
    def in_control(self) -> bool | None:
        """None where there are too few earlier checks to say."""
        return None if self.basis.too_few else not self.signals


def judged(past: Past, now_mm: float, signed: bool, control: ControlTable) -> History:
    """Figures of earlier checks, and that of today.

    What cannot be negative is charted as its power 2/3, by which a scatter becomes nearly normal (Wilson and Hilferty,
    PNAS 17 (1931) 684), and only large ones, or rising ones, are out of control.
    """
    base = np.flatnonzero(past.well)[: control.baseline]
    charted = _to_chart(np.append(past.values_mm, now_mm), signed)
    late = charted[base[-1] + 1 :] if len(base) else charted
    found = chart(charted[base], late, past.days[base], control.alpha, control.fewest, control.weight)
    single = found.limits
    counts = single.basis, len(past.values_mm), past.not_used
    if single.centre is None or single.lower is None or single.upper is None:
        return History(*counts, None, None, None, None, None, None, (), ())
    rows = _rows(found, signed)
    counted = [row for row in rows if row.rule in control.rows]
    average, half = float(found.averages.averages[-1]), float(found.averages.half[-1])

    def back(value: float) -> float:
        return value if signed else max(value, 0.0) ** 1.5

    return History(
        *counts,
        back(single.centre),
        single.lower if signed else None,
        back(single.upper),
        back(average),
        single.centre - half if signed else None,
        back(single.centre + half),
        (
            *([_BEYOND] if found.beyond and (signed or charted[-1] > single.centre) else []),
            *([_DRIFTED] if found.drifted and (signed or average > single.centre) else []),
            *counted,
        ),
        tuple(row.words for row in rows if row not in counted),
    )


def _to_chart(values_mm: F64, signed: bool) -> F64:
    return values_mm if signed else np.asarray(np.abs(values_mm) ** (2.0 / 3.0))


_BEYOND = Signal("limits", worded("beyond the limits of its history"), slow=False)
_DRIFTED = Signal("average", worded("the average of the last checks has left the mean"), slow=True)
SIGNALS = (_BEYOND.words, _DRIFTED.words, *(rule.words for rule in RULES.values()))
"""All that may be out of control, in words."""


def _rows(found: Chart, signed: bool) -> list[Signal]:
    """That go on to the newest figure; of what cannot be negative only upward."""
    if found.rows is None:
        return []
    ending = found.rows.ending(found.new - 1)
    return [Signal(run.rule, run.words, slow=True) for run in ending if signed or run.upward]
