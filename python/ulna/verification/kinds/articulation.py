"""L_Dia: one ball touched in several orientations of the probe."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from ulna.formats.numbers import Count
from ulna.geometry.enclosing import enclosing_sphere
from ulna.geometry.sphere import fit_sphere
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.verification.bench import Bench, Found, called, counted, counted_each
from ulna.verification.figures.iso_10360_12 import L_DIA
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import WantedBall
from ulna.verification.outcome import Labels, Single
from ulna.verification.touches import Touches


class ArticulationTest(TestTable):
    """L_Dia: one ball touched in several orientations of the probe."""

    kind: Literal["articulation"]
    orientations: Count
    points: Count
    """In each orientation."""


BALL = WantedBall()


def _steps(name: str, table: ArticulationTest) -> Iterator[Step]:
    for orientation in range(1, table.orientations + 1):
        what = worded(
            "probe in orientation {orientation}: touch the {artefact} over half of it",
            orientation=orientation,
            artefact=BALL.name,
        )
        yield from [Step(name, BALL.name, "1", str(orientation), what=what)] * table.points


def _evaluate(name: str, table: ArticulationTest, touches: Touches, bench: Bench) -> Found:
    """Each ball in each position is a measurement of all orientations. Raises UlnaInputError."""
    values, points, departures = [], {}, []
    for (artefact, position), standing in touches.groups(("artefact", "position")):
        centres = []
        for (orientation,), own in standing.groups(("orientation",)):
            what = called(artefact=artefact, position=position, orientation=orientation)
            centres.append(fit_sphere(own.p_mm, f"{own.path}: test '{name}', {what}").centre_mm)
            points[what] = len(own.row)
        if len(centres) < 2:
            raise UlnaInputError(
                worded(
                    "{path}: test '{test}', {of}: all {count} points are of one orientation of the probe; expected "
                    "{expected} orientations in the column 'orientation'. Add it.",
                    path=str(standing.path),
                    test=name,
                    of=called(artefact=artefact, position=position),
                    count=len(standing.row),
                    expected=table.orientations,
                )
            )
        value = float(enclosing_sphere(np.stack(centres)).diameter_mm)
        values.append(Single(Labels(artefact, position), value, bench.surroundings.standing()))
        departures += counted("orientations of the probe", len(centres), table.orientations)
    departures += counted_each("points in an orientation", points, table.points)
    return Found([(L_DIA, values)], departures)


ARTICULATION = TestKind(
    table=ArticulationTest,
    figures=lambda table: [L_DIA],
    artefacts=lambda table: [BALL],
    steps=_steps,
    evaluate=_evaluate,
    limits={"L_Dia": 0.060},
    growing=None,
    moved=False,
    length_errors=False,
    again=worded("Touch the ball again in every orientation of the probe."),
    look=worded("Look at the probe: tight, straight, its ball clean and unworn; an offset shows here first."),
    words=(),
    examples=lambda: [ArticulationTest(kind="articulation", orientations=3, points=5)],
)
