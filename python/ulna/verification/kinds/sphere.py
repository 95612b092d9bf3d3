"""P_Size and P_Form: one ball touched all around, in several places."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from ulna.formats.numbers import Count
from ulna.geometry.sphere import fit_sphere
from ulna.ground.worded import worded
from ulna.verification.bench import Bench, Found, called, counted, counted_each, tip_mm
from ulna.verification.figures.iso_10360_12 import P_FORM, P_SIZE, probing_of
from ulna.verification.kinds.kind import TestKind, TestTable
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import WantedBall
from ulna.verification.outcome import Labels, Single
from ulna.verification.touches import Touches


class SphereTest(TestTable):
    """P_Size and P_Form: one ball touched all around, in several places."""

    kind: Literal["sphere"]
    positions: Count
    points: Count
    """On the ball in each place."""


BALL = WantedBall()


def _steps(name: str, table: SphereTest) -> Iterator[Step]:
    for position in range(1, table.positions + 1):
        what = worded(
            "{artefact} in place {position}: touch it all around, over half of it",
            artefact=BALL.name,
            position=position,
        )
        yield from [Step(name, BALL.name, str(position), what=what)] * table.points


def _evaluate(name: str, table: SphereTest, touches: Touches, bench: Bench) -> Found:
    """Each artefact in each position is a measurement; the worse one stands for the figure. Raises UlnaInputError."""
    sizes, forms, points = [], [], {}
    for (artefact, position, repeat), own in touches.groups(("artefact", "position", "repeat")):
        ball = bench.ball(artefact, name)
        tip = tip_mm(own, bench.path, name)
        what = called(ball=ball.name, position=position, repeat=repeat)
        fitted = fit_sphere(own.p_mm, f"{own.path}: test '{name}', {what}")
        size, form = probing_of(fitted, ball.diameter_mm, tip, ball.table.inside)
        labels = Labels(ball.name, position, repeat=repeat)
        value = float(size.value)
        sizes.append(Single(labels, value, ball.size_budget, ball.diameter_mm, ball.diameter_mm + value))
        forms.append(Single(labels, float(form.value), ball.form_budget))
        points[what] = len(own.row)
    departures = counted("positions of the ball", len(sizes), table.positions)
    departures += counted_each("points on the ball", points, table.points)
    return Found([(P_SIZE, sizes), (P_FORM, forms)], departures)


SPHERE = TestKind(
    table=SphereTest,
    figures=lambda table: [P_SIZE, P_FORM],
    artefacts=lambda table: [BALL],
    steps=_steps,
    evaluate=_evaluate,
    limits={"P_Size": 0.040, "P_Form": 0.080},
    growing=None,
    moved=False,
    length_errors=False,
    again=worded("Touch the ball again, over half of it."),
    look=worded("Look at the probe's ball and at the ball of the check: clean, unworn, nothing loose."),
    words=(),
    examples=lambda: [SphereTest(kind="sphere", positions=2, points=9)],
)
