"""Single-point articulation: one seat touched again and again while elbow and wrist move."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ulna.formats.numbers import Count, Shares
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.verification.bench import Bench, Found, called, counted, counted_each, within_shares
from ulna.verification.departures import AWAY_NOT_CHECKED, SEATS_NOT_CHECKED
from ulna.verification.figures.asme_b89_4_22 import SPAT_2S, SPAT_MAX
from ulna.verification.figures.asme_b89_4_22 import single_point as asme
from ulna.verification.figures.faro import SPAT_AXES, half_ranges
from ulna.verification.figures.figure import Definition, Figure
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import WantedSeat
from ulna.verification.outcome import Labels, Single
from ulna.verification.touches import Touches


class SinglePointTest(TestTable):
    """One seat touched again and again while elbow and wrist move, near, at middle reach, and far."""

    kind: Literal["single-point"]
    positions: Count
    """Seats."""
    points: Count
    """Touches of each."""
    figures: Annotated[list[Literal["asme", "faro"]], Field(min_length=1)]
    """Whose figures: ASME's deviations from the mean, FARO's half ranges of the coordinates."""
    shares: Shares = Field(default_factory=list)
    """Of the reach, half the range: [least, most] distance of each seat from the base, the nearest first."""


SEAT = WantedSeat(places={"near": (0.1, 0.2), "middle": (0.45, 0.55), "far": (0.8, 0.9)})


def _figures(table: SinglePointTest) -> list[Definition]:
    asme = [SPAT_MAX, SPAT_2S] if "asme" in table.figures else []
    return [*asme, *(SPAT_AXES if "faro" in table.figures else ())]


def _steps(name: str, table: SinglePointTest) -> Iterator[Step]:
    named = list(SEAT.places) if table.positions == len(SEAT.places) else range(1, table.positions + 1)
    for place in map(str, named):
        what = worded("seat '{place}': touch it, move elbow and wrist between touches", place=place)
        yield from [Step(name, SEAT.name, place, what=what)] * table.points


def _evaluate(name: str, table: SinglePointTest, touches: Touches, bench: Bench) -> Found:
    """Each position is a seat. Raises UlnaInputError."""
    found: dict[Definition, list[Single]] = {}
    points, away_mm = {}, {}
    standing = bench.surroundings.standing()
    for (artefact, position), own in touches.groups(("artefact", "position")):
        what = called(artefact=artefact, position=position)
        if len(own.row) < 2:
            raise UlnaInputError(
                f"{own.path}: row {own.row[0]}: test '{name}', {what}: touched once; expected {table.points} touches "
                "of each seat. Take more, or correct the column 'position'."
            )
        figures: list[Figure] = []
        if "asme" in table.figures:
            figures += asme(own.p_mm)
        if "faro" in table.figures:
            figures += half_ranges(own.p_mm)
        for figure in figures:
            single = Single(Labels(artefact, position), float(figure.value), standing)
            found.setdefault(figure.definition, []).append(single)
        points[what] = len(own.row)
        away_mm[what] = float(np.linalg.norm(own.p_mm.mean(axis=0)))
    departures = counted("seats", len(points), table.positions) + counted_each(
        "touches of a seat", points, table.points
    )
    departures += _shares(away_mm, table, touches, bench)
    return Found(list(found.items()), departures)


def _shares(away_mm: dict[str, float], table: SinglePointTest, touches: Touches, bench: Bench) -> list[str]:
    """Whether the seats stood as far out as the profile asks."""
    if not table.shares or len(away_mm) != len(table.shares):
        return []
    if touches.source == "xyz":
        return [worded(AWAY_NOT_CHECKED)]
    if bench.range_mm is None:
        return [worded(SEATS_NOT_CHECKED)]
    return within_shares("seat", away_mm, table.shares, bench.range_mm)


SINGLE_POINT = TestKind(
    table=SinglePointTest,
    figures=_figures,
    artefacts=lambda table: [SEAT],
    steps=_steps,
    evaluate=_evaluate,
    limits={"SPAT_2S": 0.060},
    growing=2,
    moved=True,
    length_errors=False,
    again=worded("Touch the seat again, elbow and wrist moved between touches, the probe pressed lightly."),
    look=worded("Look at the probe (tight, its ball clean and unworn) and at its seat (clean, does not give way)."),
    words=(),
    examples=lambda: [
        SinglePointTest(
            kind="single-point", positions=3, points=5, figures=["asme"], shares=[[0, 0.2], [0.4, 0.6], [0.8, 1]]
        ),
        SinglePointTest(kind="single-point", positions=1, points=5, figures=["faro"]),
    ],
)
