"""A figure over time: whether it drifts, when it will meet its limit, and whether it is in control."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
from sqlalchemy import Connection, select

from ulna.control.chart import Chart, chart
from ulna.control.drift import Drift, drift
from ulna.control.shewhart import FEWEST
from ulna.control.until import Until, until
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import recalled, worded
from ulna.records import asked
from ulna.records.acts.event import BREAK_WORDS, BREAKS
from ulna.records.history import Point, figures
from ulna.records.tables import EVENT

LONGEST_BASELINE = 20


@dataclass(frozen=True)
class Trend:
    """Of one figure of one arm, in its unit."""

    arm: str
    figure: str
    points: list[Point]
    days: F64
    """(N,) since the first."""
    drift: Drift
    until: Until | None
    """None where no limit is stated."""
    baseline: int
    """So many of the first figures: a time when all was well."""
    chart: Chart
    """Of those after it."""
    breaks: list[str]
    """What happened meanwhile that may have changed the arm: "2026-05-04 repair: …"."""


def trend(
    connection: Connection,
    arm: str,
    figure: str,
    state: str | None = None,
    artefact: str | None = None,
    since: str | None = None,
    limit: float | None = None,
    guard: float = 0.0,
    baseline: int | None = None,
) -> Trend:
    """limit: which the figure's size may not exceed; None: that of the last figure that states one. guard: of the
    limit. baseline: so many of the first figures; None: half of them, 20 at most. Raises UlnaInputError where there
    is no such figure, or limits are none."""
    name = str(asked.equipment(connection, arm, ("arm", "robot"))["name"])
    if baseline is not None and baseline < 1:
        raise UlnaInputError(f"record: baseline: got {baseline} figures; expected 1 at least. Correct it.")
    points = [each for each in figures(connection, name, figure, state, artefact) if each.at >= (since or "")]
    _one_kind(points, figure)
    if not points:
        raise UlnaInputError(f"record: no figure '{figure}' of '{name}' since {since}. Name an earlier day.")
    when = np.array([datetime.fromisoformat(each.at).timestamp() for each in points]) / 86400.0
    days = when - when[0]
    values = [each.value for each in points]
    stated = [each.u for each in points]
    u = None if any(each is None or each <= 0.0 for each in stated) else [float(each or 0.0) for each in stated]
    found = drift(days, values, u) if np.ptp(days) > 0.0 else drift(days[:1], values[:1])
    said = limit if limit is not None else next((each.limit for each in reversed(points) if each.limit), None)
    first = baseline if baseline is not None else min(LONGEST_BASELINE, max(FEWEST, len(values) // 2))
    first = min(first, len(values))
    return Trend(
        name,
        figure,
        points,
        days,
        found,
        None if said is None else until(found, said, guard=guard),
        first,
        chart(values[:first], values[first:], days[:first]),
        _breaks(connection, name, points),
    )


def _one_kind(points: Sequence[Point], figure: str) -> None:
    """Raises UlnaInputError for figures of several states or artefacts, which are no one series."""
    for what, option in (("state", "--state"), ("artefact", "--artefact")):
        kinds = sorted({str(getattr(each, what)) for each in points})
        if len(kinds) > 1:
            raise UlnaInputError(
                f"record: '{figure}' is there of several {what}s ({', '.join(kinds)}), which are no one series; "
                f"expected one. Name it with {option}."
            )


def _breaks(connection: Connection, arm: str, points: Sequence[Point]) -> list[str]:
    asked_for = (
        select(EVENT)
        .where(EVENT.c.equipment == arm, EVENT.c.kind.in_(BREAKS))
        .where(EVENT.c.at > points[0].at, EVENT.c.at <= points[-1].at)
        .order_by(EVENT.c.at)
    )
    rows: list[Any] = asked.rows(connection, asked_for)
    return [
        worded("{day} {kind}: {text}", day=row["at"][:10], kind=recalled(row["kind"], BREAK_WORDS), text=row["text"])
        for row in rows
    ]
