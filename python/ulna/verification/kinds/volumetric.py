"""Volumetric: ball bars in various places and directions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from pydantic import Field

from ulna.formats.numbers import Count, Shares
from ulna.ground.errors import UlnaInputError
from ulna.verification.bench import Bench, Found, counted, within_shares
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
            f"{touches.path}: test '{name}': one length; expected {table.positions}, each with its own label in the "
            "column 'position'. Add them."
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
    factors = {"Volumetric_2S": 2.0, "Volumetric_half_range": 1.0, "Volumetric_2RMS": 2.0}
    figures = [(VOLUMETRIC_MAX, singles)]
    for figure in spreads:
        key = figure.definition.key
        # a bar's own error is in all deviations of it: it moves their mean, not their spread
        own = longest.budget if key == "Volumetric_2RMS" else standing
        budget = own.times(factors[key], "as the figure is of the deviations")
        figures.append((figure.definition, [Single(Labels(), float(figure.value), budget)]))
    bars = {each.name: each.calibrated_mm for each, _ in measured}
    departures = counted("lengths measured", len(singles), table.positions)
    departures += counted("bars", len(bars), table.lengths)
    departures += _shares(bars, table, bench)
    return Found(figures, departures)


def _shares(bars: dict[str, float], table: VolumetricTest, bench: Bench) -> list[str]:
    """Whether the bars are as long as the profile asks."""
    if not table.shares or len(bars) != len(table.shares):
        return []
    if bench.range_mm is None:
        return ["the measuring range is not stated (key 'range'): the lengths of the bars were not checked."]
    return within_shares("bar", bars, table.shares, bench.range_mm)


VOLUMETRIC = TestKind(
    table=VolumetricTest,
    figures=lambda table: [VOLUMETRIC_MAX, VOLUMETRIC_2S, VOLUMETRIC_HALF_RANGE, VOLUMETRIC_2RMS],
    artefacts=_artefacts,
    steps=_steps,
    evaluate=_evaluate,
    limits={"Volumetric_max": 0.080, "Volumetric_2S": 0.080},
    length_errors=True,
    words=WORDS,
    examples=lambda: [VolumetricTest(kind="volumetric", positions=6, lengths=2, shares=[[0.5, 0.75], [0.8, 1.0]])],
)
