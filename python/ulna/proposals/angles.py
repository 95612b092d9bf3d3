"""Which columns are the encoders' angles, and in which unit. What leaves a doubt is asked."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.proposals.answers import Answers, Question
from ulna.proposals.columns import Column, Taken
from ulna.proposals.words import ANGLE_UNITS

MOST_TURNS = 2
#: rad: an arm that is calibrated has turned some joint at least so far
LEAST_SPAN = 0.5
#: an angle in degrees has as many; what is beyond are counts
MOST_DEG = 360.0 * MOST_TURNS
MOST_RAD = 2 * math.pi * MOST_TURNS


@dataclass(frozen=True)
class Angles:
    """The columns of the axes from the base on."""

    columns: list[Column]
    taken: list[Taken]

    @property
    def count(self) -> int:
        """Number of axes."""
        return len(self.columns)


def angles_of(
    path: Path, columns: Sequence[Column], mapped: Mapping[str, str], joints: Sequence[str | None] | None
) -> Angles | Question:
    """The columns of the angles. mapped: Ulna's name → the file's, as it was said; joints: names of the joints that are
    known, None where nothing is. Raises UlnaInputError where there are none."""
    by_name = {column.name: column for column in columns}
    said = {ours: theirs for ours, theirs in mapped.items() if re.fullmatch(r"q\d+", ours) and theirs in by_name}
    if said:
        in_order = sorted(said, key=lambda ours: int(ours[1:]))
        return _taken([by_name[said[ours]] for ours in in_order], [worded("said with --column")] * len(said))
    if joints and all(name in by_name for name in joints):
        return _taken(
            [by_name[str(name)] for name in joints], [worded("the joint's name in the drawing")] * len(joints)
        )
    groups: dict[str, list[Column]] = {}
    for column in columns:
        heading = column.meaning
        if heading.role == "angle" and heading.number is not None and column.numeric and not heading.goal:
            groups.setdefault(re.sub(r"\d+", "#", column.name), []).append(column)
    whole = {key: ordered for key, group in groups.items() if (ordered := _ordered(group))}
    fitting = {key: group for key, group in whole.items() if joints is None or len(group) == len(joints)} or whole
    if len(fitting) == 1:
        group = next(iter(fitting.values()))
        zero = group[0].meaning.number == 0
        why = [f"'{c.meaning.word}' {c.meaning.number}" for c in group]
        if zero:
            why = [worded("{column}, counted from 0", column=each) for each in why]
        return _taken(group, why)
    if fitting:
        shown = " or ".join(f"'{group[0].name}' to '{group[-1].name}'" for group in fitting.values())
        asks = worded("which columns are the encoders' angles, {columns}", columns=shown)
        return Question("columns", "--column q1=NAME --column q2=NAME …", asks)
    there = ", ".join(f"'{column.name}'" for column in columns)
    raise UlnaInputError(
        f"{path}: no columns of angles are recognised among {there[:200]}; expected one for each axis, with its "
        "number, such as 'q1', 'Axis 1', 'Achse 1' or '轴1'. Say which they are, from the base on: "
        "--column q1=NAME --column q2=NAME and so on."
    )


def _ordered(group: list[Column]) -> list[Column]:
    """From axis 1 (or 0) to the last; [] where some are missing or twice."""
    ordered = sorted(group, key=lambda column: column.meaning.number or 0)
    numbers = [column.meaning.number for column in ordered]
    first = numbers[0]
    return (
        ordered if len(numbers) > 1 and first in (0, 1) and numbers == list(range(first, first + len(numbers))) else []
    )


def _taken(columns: list[Column], why: list[str]) -> Angles:
    rows = zip(columns, why, strict=True)
    return Angles(columns, [Taken(column.name, f"q{k}", each) for k, (column, each) in enumerate(rows, start=1)])


def unit_of(path: Path, angles: Angles, answers: Answers) -> tuple[str, str] | Question:
    """The unit of the angles, and why. Raises UlnaInputError where what is said and what the file says differ."""
    own = {ANGLE_UNITS.get(column.meaning.unit, "") for column in angles.columns} - {""}
    heads = next((column.meaning.unit for column in angles.columns if column.meaning.unit in ANGLE_UNITS), "")
    if len(own) > 1:
        raise UlnaInputError(
            f"{path}: the columns of angles have different units ({', '.join(sorted(own))}); expected one unit. Write "
            "all in one."
        )
    if answers.angle is not None:
        if own and own != {answers.angle}:
            raise UlnaInputError(
                f"{path}: --angle says {answers.angle}, but the file says '{heads}' of its angles; expected the same. "
                "Leave --angle out, or correct the file."
            )
        return answers.angle, worded("said with --angle")
    if own:
        return own.pop(), worded("the file says '{unit}'", unit=heads)
    return _by_range(angles)


def _by_range(angles: Angles) -> tuple[str, str] | Question:
    values = [column.numbers.drop_nulls().drop_nans().to_numpy() for column in angles.columns]
    # one cell in a hundred may be anything
    low = [float(np.quantile(each, 0.01, method="nearest")) for each in values]
    high = [float(np.quantile(each, 0.99, method="nearest")) for each in values]
    most, span = max(map(abs, [*low, *high])), max(h - lo for lo, h in zip(low, high, strict=True))
    whole = all(bool((each == np.round(each)).all()) for each in values)
    between = {"low": f"{min(low):.6g}", "high": f"{max(high):.6g}"}
    seen = (
        worded("they go from {low} to {high}, all whole numbers", **between)
        if whole
        else worded("they go from {low} to {high}", **between)
    )
    if whole and most > MOST_DEG:
        return "counts", seen
    if not whole and span >= LEAST_SPAN and most <= MOST_RAD:
        return "rad", worded("{seen}: in degrees the arm would hardly have moved", seen=seen)
    if not whole and 3 * MOST_RAD < most <= MOST_DEG:
        return "deg", worded("{seen}: more than two turns in rad", seen=seen)
    asks = worded("in which unit are the angles: {seen}", seen=seen)
    return Question("angle", "--angle rad, deg or counts", asks, ("rad", "deg", "counts"))


def counts_question(angles: Angles) -> Question:
    """How many counts a turn has: shown is what they spread over, never taken from it."""
    spread = max(float(c.numbers.max() or 0) - float(c.numbers.min() or 0) for c in angles.columns)  # type: ignore[arg-type]
    return Question(
        "counts_per_turn",
        f"--counts-per-turn N, once or {angles.count} times",
        worded(
            "how many counts has one turn of an encoder (the readings spread over {spread}; one number, or one for "
            "each of the {count} axes)",
            spread=f"{spread:.0f}",
            count=angles.count,
        ),
    )
