"""Volumetric: ball bars in various places and directions."""

from __future__ import annotations

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.verification.bench import Bench, Found, counted, within_shares
from ulna.verification.figures.asme_b89_4_22 import VOLUMETRIC_MAX
from ulna.verification.figures.asme_b89_4_22 import volumetric as asme
from ulna.verification.figures.lengths import OPPOSING
from ulna.verification.kinds.measured_lengths import measured_lengths
from ulna.verification.outcome import Labels, Single
from ulna.verification.profile_tables import VolumetricTest
from ulna.verification.touches import Touches


def volumetric(name: str, table: VolumetricTest, touches: Touches, bench: Bench) -> Found:
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
