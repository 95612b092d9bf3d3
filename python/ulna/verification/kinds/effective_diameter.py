"""Effective diameter: one ball measured several times."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from ulna.formats.numbers import Count
from ulna.geometry.sphere import fit_sphere
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.verification.bench import Bench, Found, called, counted, counted_each, tip_mm
from ulna.verification.budget import Budget
from ulna.verification.figures.asme_b89_4_22 import DIAMETER, DIAMETER_SPREAD, DIAMETER_WORST, effective_diameter_of
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import WantedBall
from ulna.verification.outcome import Labels, Single
from ulna.verification.touches import Touches


class DiameterTest(TestTable):
    """Effective diameter: one ball measured several times."""

    kind: Literal["effective-diameter"]
    repeats: Count
    points: Count
    """Of each measurement."""


BALL = WantedBall()


def _steps(name: str, table: DiameterTest) -> Iterator[Step]:
    for repeat in range(1, table.repeats + 1):
        what = worded(
            "{artefact} near middle reach, measurement {repeat}: touch it all around",
            artefact=BALL.name,
            repeat=repeat,
        )
        yield from [Step(name, BALL.name, repeat=str(repeat), what=what)] * table.points


def _evaluate(name: str, table: DiameterTest, touches: Touches, bench: Bench) -> Found:
    """Each ball is measured in several repeats. Raises UlnaInputError."""
    means, worst, spreads, departures = [], [], [], []
    for (artefact,), standing in touches.groups(("artefact",)):
        ball = bench.ball(artefact, name)
        singles, points = [], {}
        for (position, repeat), own in standing.groups(("position", "repeat")):
            what = called(ball=ball.name, position=position, repeat=repeat)
            fitted = fit_sphere(own.p_mm, f"{own.path}: test '{name}', {what}")
            diameter = 2.0 * float(fitted.radius_mm) - tip_mm(own, bench.path, name) * (-1 if ball.table.inside else 1)
            labels = Labels(ball.name, position, repeat=repeat)
            singles.append(Single(labels, diameter - ball.diameter_mm, ball.size_budget, ball.diameter_mm, diameter))
            points[what] = len(own.row)
        if len(singles) < 2:
            raise UlnaInputError(
                worded(
                    "{path}: test '{test}', ball {ball}: all {count} points are of one measurement; expected "
                    "{expected} in the column 'repeat'. Add it.",
                    path=str(standing.path),
                    test=name,
                    ball=ball.name,
                    count=len(standing.row),
                    expected=table.repeats,
                )
            )
        mean, _, spread = effective_diameter_of(np.array([single.value_mm for single in singles]))
        labels = Labels(ball.name)
        mean_mm = ball.diameter_mm + float(mean.value)
        means.append(Single(labels, float(mean.value), ball.size_budget, ball.diameter_mm, mean_mm))
        worst += singles
        spreads.append(Single(labels, float(spread.value), _of_spread()))
        departures += counted("measurements of the ball", len(singles), table.repeats)
        departures += counted_each("points of a measurement", points, table.points)
    return Found([(DIAMETER, means), (DIAMETER_WORST, worst), (DIAMETER_SPREAD, spreads)], departures)


def _of_spread() -> Budget:
    """The same ball each time: what is wrong with its calibration is in no difference."""
    return Budget([], ["nothing of the artefact: it is the same in every measurement"])


EFFECTIVE_DIAMETER = TestKind(
    table=DiameterTest,
    figures=lambda table: [DIAMETER, DIAMETER_WORST, DIAMETER_SPREAD],
    artefacts=lambda table: [BALL],
    steps=_steps,
    evaluate=_evaluate,
    limits={"Diameter_max": 0.040},
    growing=None,
    moved=False,
    length_errors=False,
    again=worded("Touch the ball again, over half of it."),
    look=worded("Look at the probe's ball, clean and unworn: is it the one that the arm file has?"),
    words=(),
    examples=lambda: [DiameterTest(kind="effective-diameter", repeats=3, points=9)],
)
