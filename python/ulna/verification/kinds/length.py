"""E_Uni and E_Bi: calibrated lengths in several places."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Literal

from ulna.formats.numbers import Count, Share
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.verification.bench import Bench, Found, called, counted, counted_each
from ulna.verification.departures import LONGEST, LONGEST_NOT_CHECKED
from ulna.verification.figures.figure import Definition
from ulna.verification.figures.iso_10360_12 import E_BI, E_UNI
from ulna.verification.figures.lengths import OPPOSING
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.measured_lengths import LONGEST_SHARE, WORDS, measured_lengths
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import WantedLength
from ulna.verification.touches import Touches


class LengthTest(TestTable):
    """E_Uni or E_Bi: calibrated lengths in several places."""

    kind: Literal["length"]
    direction: Literal["uni", "bi"]
    """Both ends touched from the same direction (or centre to centre), or from opposing ones."""
    lengths: Count
    positions: Count
    repeats: Count
    longest_share: Share | None = None
    """Of the measuring range: the longest length is to be at least so long."""


def _figures(table: LengthTest) -> list[Definition]:
    return [{"uni": E_UNI, "bi": E_BI}[table.direction]]


def _artefacts(table: LengthTest) -> list[WantedLength]:
    """Evenly up to the longest: a little above the least share, so that a length rounded to mm is not below it."""
    longest = 1.01 * (table.longest_share or LONGEST_SHARE)
    numbers = range(1, table.lengths + 1)
    if table.direction == "bi":
        return [WantedLength(f"gauge-{k}", longest * k / table.lengths, "opposite-faces") for k in numbers]
    return [WantedLength(f"length-{k}", longest * k / table.lengths, "seats") for k in numbers]


def _steps(name: str, table: LengthTest) -> Iterator[Step]:
    for each in _artefacts(table):
        for position in range(1, table.positions + 1):
            for repeat in range(1, table.repeats + 1):
                yield from each.steps(name, str(position), str(repeat))


def _evaluate(name: str, table: LengthTest, touches: Touches, bench: Bench) -> Found:
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
    return Found([(figure, values) for figure in _figures(table)], departures)


def _longest(longest_mm: float, table: LengthTest, bench: Bench) -> list[str]:
    if table.longest_share is None:
        return []
    if bench.range_mm is None:
        return [worded(LONGEST_NOT_CHECKED, length=f"{longest_mm:.1f}", least=f"{100 * table.longest_share:g}")]
    share = longest_mm / bench.range_mm
    if share >= table.longest_share:
        return []
    return [
        worded(
            LONGEST,
            length=f"{longest_mm:.1f}",
            share=f"{100 * share:.0f}",
            least=f"{100 * table.longest_share:g}",
        )
    ]


LENGTH = TestKind(
    table=LengthTest,
    figures=_figures,
    artefacts=_artefacts,
    steps=_steps,
    evaluate=_evaluate,
    limits={"E_Uni": {"a": 0.040, "b": 40000.0}, "E_Bi": {"a": 0.050, "b": 40000.0}},
    growing=None,
    moved=False,
    length_errors=True,
    again=worded("Touch the length again in that place, both ends."),
    look=worded("Look at the bar: its seats clean, its supports as always, as warm as the protocol says."),
    words=WORDS,
    examples=lambda: [
        LengthTest(kind="length", direction="uni", lengths=2, positions=2, repeats=2, longest_share=0.5),
        LengthTest(kind="length", direction="bi", lengths=2, positions=2, repeats=1),
    ],
)
