"""When an arm should come back: advice by three methods, each with what it rests on, and the decision, which somebody
takes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import pairwise
from statistics import median
from typing import Any

from sqlalchemy import Connection, func, select

from ulna.control.a3 import interval_test
from ulna.control.staircase import staircase
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.records import asked, chain
from ulna.records.bench import Bench, checked_text
from ulna.records.entry import Entry
from ulna.records.filed.kind import BAD
from ulna.records.history import withdrawn
from ulna.records.registering import chosen
from ulna.records.tables import CALIBRATION, EQUIPMENT, FIGURE
from ulna.records.trend import trend

AS_FOUND = "as-found"
BOUNDS_DAYS = (30.0, 1826.0)
"""No shorter and no longer than these: a month and five years."""
_A_YEAR = 365.0


@dataclass(frozen=True)
class Wanted:
    """What advice is asked for."""

    arm: str
    figure: str | None = None
    limit: float | None = None
    guard: float = 0.0
    target: float = 0.95
    """Of the share found in tolerance."""


@dataclass(frozen=True)
class Advice:
    """Of one method."""

    method: str
    days: float | None
    """None where there is too little to go by."""
    n: int
    """Calibrations, or figures, that it rests on."""
    now_days: float | None
    """The interval until now."""
    reason: str


def advise(connection: Connection, wanted: Wanted, method: str) -> Advice:
    """Raises UlnaInputError for a method that is none, or an arm that is not registered."""
    chosen("option --method", method, tuple(METHODS))
    arm = str(asked.equipment(connection, wanted.arm, ("arm", "robot"))["name"])
    return METHODS[method](connection, arm, wanted)


def _by_staircase(connection: Connection, arm: str, wanted: Wanted) -> Advice:
    """From the last test as found."""
    rows = _as_found(connection, [arm])
    current = _interval(connection, arm, rows)
    last = [row for row in rows if rows and row["at"] == rows[-1]["at"] and row["limit_value"]]
    figures = {str(row["name"]): (float(row["value"]), float(row["limit_value"])) for row in last}
    found = staircase(figures, current, bounds_days=BOUNDS_DAYS)
    return Advice("staircase", found.interval_days, found.basis.n, current, found.reason)


def _by_drift(connection: Connection, arm: str, wanted: Wanted) -> Advice:
    """From a figure as found, over time, to its limit."""
    if wanted.figure is None:
        raise UlnaInputError("record: advice by drift is of a figure; expected its name. Give --figure NAME.")
    found = trend(connection, arm, wanted.figure, AS_FOUND, limit=wanted.limit, guard=wanted.guard)
    if found.until is None:
        raise UlnaInputError(f"record: no limit of '{wanted.figure}' is stated; expected one. Give --limit MM.")
    current = _interval(connection, arm, _as_found(connection, [arm]))
    n = found.drift.basis.n
    return Advice("drift to the limit", found.until.interval_days, n, current, found.until.reason)


def _by_fleet(connection: Connection, arm: str, wanted: Wanted) -> Advice:
    """From how many arms of this model were in tolerance as found."""
    model = asked.equipment(connection, arm)["model"]
    rows = asked.rows(connection, asked.newest(EQUIPMENT, "name"))
    same = [str(row["name"]) for row in rows if row["kind"] in ("arm", "robot") and row["model"] == model]
    fleet = same if model else [arm]
    found = _as_found(connection, fleet)
    tests: dict[tuple[str, str], bool] = {}
    for row in found:
        key = (str(row["arm"]), str(row["at"]))
        tests[key] = tests.get(key, True) and row["verdict"] != BAD
    current = _interval(connection, arm, found)
    tested = interval_test(sum(tests.values()), len(tests), current, wanted.target, bounds_days=BOUNDS_DAYS)
    said = {"good": str(sum(tests.values())), "all": str(len(tests)), "arms": str(len(fleet))}
    of = (
        worded("{good} of {all} tests of 1 arm in tolerance as found", good=said["good"], all=said["all"])
        if len(fleet) == 1
        else worded("{good} of {all} tests of {arms} arms in tolerance as found", **said)
    )
    if tested.interval_days is None:
        few = worded("{of}: {basis}.", of=of, basis=tested.basis.said)
        return Advice("NCSLI RP-1 A3", None, len(tests), current, few)
    sure = worded(
        "that the interval does not keep {target} is {surely} sure",
        target=f"{wanted.target:.0%}",
        surely=f"{tested.surely or 0.0:.0%}",
    )
    done = worded("it is changed") if tested.rejected else worded("it is kept")
    why = worded("{of}; {sure}: {done}.", of=of, sure=sure, done=done)
    return Advice("NCSLI RP-1 A3", tested.interval_days, len(tests), current, why)


METHODS: dict[str, Callable[[Connection, str, Wanted], Advice]] = {
    "staircase": _by_staircase,
    "drift": _by_drift,
    "a3": _by_fleet,
}


def _as_found(connection: Connection, arms: list[str]) -> list[asked.Row]:
    asked_for = (
        select(FIGURE)
        .where(FIGURE.c.arm.in_(arms), FIGURE.c.state == AS_FOUND, FIGURE.c.limit_value.is_not(None))
        .where(FIGURE.c.sha256.not_in(withdrawn()))
        .order_by(FIGURE.c.at, FIGURE.c.seq, FIGURE.c.line)
    )
    return asked.rows(connection, asked_for)


def _interval(connection: Connection, arm: str, rows: list[asked.Row]) -> float:
    """As it was decided; else the usual time between tests; else a year."""
    decided = asked.interval(connection, arm)
    if decided is not None:
        return float(decided["days"])
    times = sorted({datetime.fromisoformat(str(row["at"])) for row in rows if row["arm"] == arm})
    gaps = [(later - earlier).total_seconds() / 86400.0 for earlier, later in pairwise(times)]
    return median(gaps) if gaps and median(gaps) >= 1.0 else _A_YEAR


def decide(
    bench: Bench, name: str, days: float, method: str | None = None, why: str | None = None, from_at: str | None = None
) -> Entry:
    """The interval of equipment from now on; it begins at from_at, else at the last calibration or test, else now.
    Raises UlnaInputError."""
    if not 1.0 <= days <= 36525.0:
        raise UlnaInputError(f"record: interval of '{name}': got {days:g} days, expected 1 to 36525. Correct it.")
    with bench.writing() as doing:
        row = asked.equipment(doing.connection, name)
        begins = from_at or _last(doing.connection, str(row["name"])) or chain.now()
        stated: dict[str, Any] = {
            "days": float(days),
            "method": checked_text(method or "as decided", "method"),
            "from_at": begins,
            "due_at": _after(name, begins, days),
        }
        return doing.add(
            "interval", str(row["name"]), stated | ({"why": checked_text(why, "why", 2000)} if why else {})
        )


def _after(name: str, begins: str, days: float) -> str:
    try:
        return (datetime.fromisoformat(begins) + timedelta(days=days)).isoformat()
    except OverflowError:
        raise UlnaInputError(
            f"record: interval of '{name}': {days:g} days from {begins[:10]} are after the year 9999; expected an "
            "earlier day. Withdraw what was filed of that day."
        ) from None


def _last(connection: Connection, name: str) -> str | None:
    """When it was calibrated or tested last."""
    times = [
        connection.scalar(select(func.max(table.c.at)).where(table.c.arm == name)) for table in (CALIBRATION, FIGURE)
    ]
    return max((time for time in times if time), default=None)
