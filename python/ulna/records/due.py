"""What must come back, and when: arms by the interval that was decided, artefacts by their certificates."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date

from sqlalchemy import Connection, select

from ulna.ground.worded import worded
from ulna.records import asked, chain
from ulna.records.tables import CERTIFIED, EQUIPMENT


@dataclass(frozen=True)
class Due:
    """Equipment in use, or quarantined."""

    name: str
    kind: str
    state: str
    due: str | None
    """Day; None: nobody said."""
    days: int | None
    """Until then; below 0: overdue."""
    why: str


def today() -> str:
    """In UTC."""
    return chain.now()[:10]


def due(connection: Connection, on: str) -> list[Due]:
    """The soonest first, then what nobody said anything of."""
    found = [
        _due(connection, row, on)
        for row in asked.rows(connection, asked.newest(EQUIPMENT, "name"))
        if row["state"] != "retired" and row["kind"] != "probe"
    ]
    return sorted(found, key=lambda each: (each.due is None, each.due or "", each.name))


def _due(connection: Connection, row: asked.Row, on: str) -> Due:
    name = row["name"]
    decided = asked.interval(connection, name)
    if decided is not None:
        day, why = (
            decided["due_at"][:10],
            worded("{days} days from {day}", days=f"{decided['days']:.0f}", day=decided["from_at"][:10]),
        )
    else:
        day = _runs_out(connection, name)
        why = worded("its certificate runs out") if day else worded("no interval was set")
    days = (date.fromisoformat(day) - date.fromisoformat(on)).days if day else None
    return Due(name, row["kind"], row["state"], day, days, why)


def _runs_out(connection: Connection, artefact: str) -> str | None:
    """The first day on which a value of its newest certificate no longer holds."""
    asked_for = select(CERTIFIED).where(CERTIFIED.c.artefact == artefact).order_by(CERTIFIED.c.seq.desc())
    newest: dict[str, str | None] = {}
    for row in asked.rows(connection, asked_for):
        newest.setdefault(row["quantity"], row["valid_to"])
    return min((day for day in newest.values() if day), default=None)
