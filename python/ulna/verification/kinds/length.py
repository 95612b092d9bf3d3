"""E_Uni and E_Bi: calibrated lengths in several places."""

from __future__ import annotations

from collections import Counter

from ulna.ground.errors import UlnaInputError
from ulna.verification.bench import Bench, Found, called, counted, counted_each
from ulna.verification.figures.iso_10360_12 import E_BI, E_UNI
from ulna.verification.figures.lengths import OPPOSING
from ulna.verification.kinds.measured_lengths import measured_lengths
from ulna.verification.profile_tables import LengthTest
from ulna.verification.touches import Touches


def length(name: str, table: LengthTest, touches: Touches, bench: Bench) -> Found:
    """Each artefact in each position and repeat is a value. Raises UlnaInputError."""
    measured = measured_lengths(name, touches, bench)
    for each, _ in measured:
        opposing = each.table.ends in OPPOSING
        if opposing != (table.direction == "bi"):
            raise UlnaInputError(
                f"{bench.path}: test '{name}' is of direction '{table.direction}', but artefact '{each.name}' has ends "
                f'= "{each.table.ends}"; expected '
                + ("opposite-faces" if table.direction == "bi" else "seats, balls or faces")
                + ". Name another test or artefact."
            )
    values = [single for _, single in measured]
    lengths = {each.name: each.calibrated_mm for each, _ in measured}
    departures = counted("lengths", len(lengths), table.lengths)
    positions: dict[str, set[str]] = {artefact: set() for artefact in lengths}
    repeats: Counter[str] = Counter()
    for single in values:
        positions[single.labels.artefact].add(single.labels.position)
        repeats[called(artefact=single.labels.artefact, position=single.labels.position)] += 1
    departures += counted_each(
        "positions of a length", {artefact: len(places) for artefact, places in positions.items()}, table.positions
    )
    departures += counted_each("repeats in a position", repeats, table.repeats)
    departures += _longest(max(lengths.values()), table, bench)
    return Found([(E_BI if table.direction == "bi" else E_UNI, values)], departures)


def _longest(longest_mm: float, table: LengthTest, bench: Bench) -> list[str]:
    if table.longest_share is None:
        return []
    if bench.range_mm is None:
        return [
            f"the measuring range is not stated (key 'range'): whether the longest length, {longest_mm:.1f} mm, is at "
            f"least {100 * table.longest_share:g} % of it was not checked."
        ]
    share = longest_mm / bench.range_mm
    if share >= table.longest_share:
        return []
    return [
        f"longest length: {longest_mm:.1f} mm, {100 * share:.0f} % of the range; the profile asks for at least "
        f"{100 * table.longest_share:g} %."
    ]
