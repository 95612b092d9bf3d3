"""Calibrations of one arm that the record has, compared."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

from sqlalchemy import Connection, select

from ulna.calibration.result import Result
from ulna.comparison.compare import MOST, Comparison, compare
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import recalled, worded
from ulna.records import asked
from ulna.records.acts.event import BREAK_WORDS, BREAKS
from ulna.records.bench import Bench
from ulna.records.history import calibrations
from ulna.records.tables import EVENT


def compare_last(bench: Bench, arm: str, last: int, probe: str | None, shared_u: float) -> Comparison:
    """The last calibrations that converged, each with the next; each is called by its day, and where the arm was
    adjusted, repaired or given another firmware between two of them, as found and as left. Raises UlnaInputError where
    there are fewer than two."""
    if not 2 <= last <= MOST:
        raise UlnaInputError(f"record: compare the last {last}: expected 2 to {MOST}. Correct it.")
    with bench.reading() as connection:
        name = asked.equipment(connection, arm)["name"]
        rows = [row for row in calibrations(connection, name) if row["converged"]][-last:]
        between = [_done(connection, name, one["at"], other["at"]) for one, other in pairwise(rows)]
    if len(rows) < 2:
        raise UlnaInputError(f"record: '{name}' has {len(rows)} calibration that converged; expected two. Add results.")
    for row in rows:
        bench.files.get(row["sha256"])  # what was changed is not compared
    results = [Result.load(bench.files.place(row["sha256"])) for row in rows]
    found = compare(*results, probe=probe, shared_u=shared_u)
    steps = [
        dataclasses.replace(
            step,
            before=_called(one, "as found" if done else ""),
            after=_called(other, "as left" if done else ""),
            between=[
                worded(
                    "{kind} on {day}, {text}",
                    kind=recalled(each["kind"], BREAK_WORDS),
                    day=each["at"][:10],
                    text=each["text"],
                )
                for each in done
            ],
        )
        for step, (one, other), done in zip(found.steps, pairwise(rows), between, strict=True)
    ]
    return dataclasses.replace(found, steps=steps)


def _called(row: asked.Row, state: str) -> str:
    return ", ".join(each for each in (row["at"][:10], state) if each) + f" ({row['sha256'][:8]})"


def _done(connection: Connection, arm: str, since: str, until: str) -> list[asked.Row]:
    """Between two times, after which an arm may be another one; the earliest first."""
    asked_for = (
        select(EVENT)
        .where(EVENT.c.equipment == arm, EVENT.c.kind.in_(BREAKS), EVENT.c.at > since, EVENT.c.at <= until)
        .order_by(EVENT.c.at, EVENT.c.seq)
    )
    return asked.rows(connection, asked_for)
