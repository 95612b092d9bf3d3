"""Volumetric: ball bars in various places and directions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

import numpy as np
from pydantic import Field

from ulna.formats.numbers import Count, Shares
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.verification.bench import Bench, Found, Length, counted, within_shares
from ulna.verification.budget import Share, of_several
from ulna.verification.departures import BARS_NOT_CHECKED
from ulna.verification.figures.asme_b89_4_22 import (
    VOLUMETRIC_2RMS,
    VOLUMETRIC_2S,
    VOLUMETRIC_HALF_RANGE,
    VOLUMETRIC_MAX,
)
from ulna.verification.figures.asme_b89_4_22 import volumetric as asme
from ulna.verification.figures.lengths import OPPOSING
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.measured_lengths import LONGEST_SHARE, WORDS, measured_lengths
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import WantedLength
from ulna.verification.outcome import Labels, Single
from ulna.verification.touches import Touches


class VolumetricTest(TestTable):
    """A ball bar in various places and directions."""

    kind: Literal["volumetric"]
    positions: Count
    """Lengths in all, of all bars."""
    lengths: Count
    """Bars."""
    shares: Shares = Field(default_factory=list)
    """Of the reach, half the range: [least, most] length of each bar, the shortest bar first."""


def _artefacts(table: VolumetricTest) -> list[WantedLength]:
    """In the middle of what is asked; bars beyond the shares are as long as the last."""
    shares = [0.25 * (least + most) for least, most in table.shares] or [LONGEST_SHARE * 0.5]
    shares += shares[-1:] * (table.lengths - len(shares))
    return [WantedLength(f"bar-{k}", share, "seats") for k, share in enumerate(shares[: table.lengths], start=1)]


def _steps(name: str, table: VolumetricTest) -> Iterator[Step]:
    """The bars take turns in the numbers of places, but one is measured after the other."""
    bars = _artefacts(table)
    places = [(bars[k % len(bars)], str(k + 1)) for k in range(table.positions)]
    for bar, place in sorted(places, key=lambda each: each[0].name):
        yield from bar.steps(name, place)


def _evaluate(name: str, table: VolumetricTest, touches: Touches, bench: Bench) -> Found:
    """Each bar in each position (and repeat) is a deviation. Raises UlnaInputError."""
    measured = measured_lengths(name, touches, bench)
    if len(measured) < 2:
        raise UlnaInputError(
            worded(
                "{path}: test '{test}': one length; expected {expected}, each with its own label in the column "
                "'position'. Add them.",
                path=str(touches.path),
                test=name,
                expected=table.positions,
            )
        )
    for each, _ in measured:
        if each.table.ends in OPPOSING:
            raise UlnaInputError(
                f"{bench.path}: test '{name}': artefact '{each.name}' has ends = \"{each.table.ends}\"; expected a "
                "ball bar: seats or balls. Name another artefact."
            )
    singles = [single for _, single in measured]
    _, *spreads = asme(np.array([single.value_mm for single in singles]))
    longest = max((each for each, _ in measured), key=lambda each: each.calibrated_mm)
    standing = bench.surroundings.standing()
    figures = [(VOLUMETRIC_MAX, singles)]
    for figure in spreads:
        key = figure.definition.key
        if key in _BY_BAR:
            budget = of_several(_shares_of(measured, _BY_BAR[key])).and_(standing.times(_FACTORS[key], _AS_FIGURE))
        else:
            budget = longest.budget.times(_FACTORS[key], _AS_FIGURE)
        figures.append((figure.definition, [Single(Labels(), float(figure.value), budget)]))
    bars = {each.name: each.calibrated_mm for each, _ in measured}
    departures = counted("lengths measured", len(singles), table.positions)
    departures += counted("bars", len(bars), table.lengths)
    departures += _shares(bars, table, bench)
    return Found(figures, departures)


def _spread_by_deviation(e_mm: F64) -> F64:
    """(n,) the change of two standard deviations of (n,) deviations with each of them; 0 where all are alike."""
    away = e_mm - e_mm.mean()
    spread = float(np.sqrt((away**2).sum() * (len(e_mm) - 1)))
    return np.asarray(2.0 * away / spread if spread > 0.0 else 0.0 * away)


def _half_range_by_deviation(e_mm: F64) -> F64:
    """(n,) the change of half the range of (n,) deviations with each of them."""
    by = np.zeros(len(e_mm))
    by[e_mm.argmax()] += 0.5
    by[e_mm.argmin()] -= 0.5
    return by


_FACTORS = {"Volumetric_2S": 2.0, "Volumetric_half_range": 1.0, "Volumetric_2RMS": 2.0}
_NOTHING = 1e-9
_AS_FIGURE = "as the figure is of the deviations"
_BY_BAR = {"Volumetric_2S": _spread_by_deviation, "Volumetric_half_range": _half_range_by_deviation}
"""Of one bar all deviations err alike, which moves their mean, not their spread; of several bars each by its own."""


def _shares_of(measured: list[tuple[Length, Single]], by_deviation: Callable[[F64], F64]) -> list[Share]:
    """Of each bar: an error of its length is in all its deviations, with the other sign."""
    change = -by_deviation(np.array([single.value_mm for _, single in measured]))
    name = np.array([length.name for length, _ in measured])
    bars = {length.name: length for length, _ in measured}
    shares = [Share(own, float(change[name == own].sum()), bar.budget) for own, bar in bars.items()]
    return [share for share in shares if abs(share.per_mm) > _NOTHING]


def _shares(bars: dict[str, float], table: VolumetricTest, bench: Bench) -> list[str]:
    """Whether the bars are as long as the profile asks."""
    if not table.shares or len(bars) != len(table.shares):
        return []
    if bench.range_mm is None:
        return [worded(BARS_NOT_CHECKED)]
    return within_shares("bar", bars, table.shares, bench.range_mm)


VOLUMETRIC = TestKind(
    table=VolumetricTest,
    figures=lambda table: [VOLUMETRIC_MAX, VOLUMETRIC_2S, VOLUMETRIC_HALF_RANGE, VOLUMETRIC_2RMS],
    artefacts=_artefacts,
    steps=_steps,
    evaluate=_evaluate,
    limits={"Volumetric_max": 0.080, "Volumetric_2S": 0.080},
    growing=None,
    moved=False,
    length_errors=True,
    again=worded("Touch the bar again in those places, both ends."),
    look=worded("Look at the bars: their seats clean, their supports as always, as warm as the protocol says."),
    words=WORDS,
    examples=lambda: [VolumetricTest(kind="volumetric", positions=6, lengths=2, shares=[[0.5, 0.75], [0.8, 1.0]])],
)
