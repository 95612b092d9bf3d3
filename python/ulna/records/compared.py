"""Calibrations of one arm that the record has, compared."""

from __future__ import annotations

import dataclasses

from ulna.calibration.result import Result
from ulna.comparison.compare import MOST, Comparison, compare
from ulna.ground.errors import UlnaInputError
from ulna.records import asked
from ulna.records.bench import Bench
from ulna.records.history import calibrations


def compare_last(bench: Bench, arm: str, last: int, probe: str | None, shared_u: float) -> Comparison:
    """The last calibrations that converged, each with the next; each is called by its day. Raises UlnaInputError where
    there are fewer than two."""
    if not 2 <= last <= MOST:
        raise UlnaInputError(f"record: compare the last {last}: expected 2 to {MOST}. Correct it.")
    with bench.reading() as connection:
        name = asked.equipment(connection, arm)["name"]
        rows = [row for row in calibrations(connection, name) if row["converged"]][-last:]
    if len(rows) < 2:
        raise UlnaInputError(f"record: '{name}' has {len(rows)} calibration that converged; expected two. Add results.")
    for row in rows:
        bench.files.get(row["sha256"])  # what was changed is not compared
    results = [Result.load(bench.files.place(row["sha256"])) for row in rows]
    found = compare(*results, probe=probe, shared_u=shared_u)
    days = [f"{row['at'][:10]} ({row['sha256'][:8]})" for row in rows]
    steps = [
        dataclasses.replace(step, before=one, after=other)
        for step, one, other in zip(found.steps, days, days[1:], strict=False)
    ]
    return dataclasses.replace(found, steps=steps)
