"""What the index is asked: the newest rows of equipment, its values, its standing. One query each, by bound
parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, Select, Table, and_, func, select

from ulna.ground.errors import UlnaInputError, nearest
from ulna.records.tables import CERTIFIED, EQUIPMENT, INTERVAL, SETTING, STANDING

Row = Mapping[str, Any]


def rows(connection: Connection, asked: Select[Any]) -> list[Row]:
    """As dictionaries by column."""
    return [dict(row._mapping) for row in connection.execute(asked)]


def newest(table: Table, key: str) -> Select[Any]:
    """Of each key the row that was written last."""
    last = select(table.c[key], func.max(table.c.seq).label("seq")).group_by(table.c[key]).subquery()
    return select(table).join(last, and_(table.c[key] == last.c[key], table.c.seq == last.c.seq)).order_by(table.c[key])


def last_of(connection: Connection, table: Table, key: str, value: str) -> Row | None:
    """The row of one key that was written last."""
    asked = select(table).where(table.c[key] == value).order_by(table.c.seq.desc(), table.c.line.desc()).limit(1)
    return next(iter(rows(connection, asked)), None)


def equipment(connection: Connection, name: str, kinds: Sequence[str] = ()) -> Row:
    """By name, or by a serial number that one thing alone has. Raises UlnaInputError for what is not registered, or is
    of another kind."""
    row = last_of(connection, EQUIPMENT, "name", name)
    if row is None:
        by_serial = [each for each in rows(connection, newest(EQUIPMENT, "name")) if each["serial"] == name]
        row = by_serial[0] if len(by_serial) == 1 else None
    if row is None:
        known = [each["name"] for each in rows(connection, newest(EQUIPMENT, "name"))]
        hint = nearest(name, known)
        raise UlnaInputError(
            f"record: '{name}' is not registered.{hint} Register it: ulna record arm, or artefact, NAME."
        )
    if kinds and row["kind"] not in kinds:
        raise UlnaInputError(
            f"record: '{name}' is registered as {row['kind']}; expected {' or '.join(kinds)}. Name another."
        )
    return row


def certified(connection: Connection, artefact: str, quantity: str, on: str) -> Row | None:
    """What the certificate says that was in force last on a day, valid still or not; None where none ever was. A later
    certificate takes the place of an earlier one, also where it runs out sooner."""
    begun = func.coalesce(CERTIFIED.c.valid_from, "")
    asked_for = (
        select(CERTIFIED)
        .where(CERTIFIED.c.artefact == artefact, CERTIFIED.c.quantity == quantity, begun <= on)
        .order_by(begun.desc(), CERTIFIED.c.seq.desc())
        .limit(1)
    )
    return next(iter(rows(connection, asked_for)), None)


def standing(connection: Connection, subject: str) -> Row | None:
    """Of a certificate or a filed result; None where nobody said anything."""
    return last_of(connection, STANDING, "subject", subject)


def interval(connection: Connection, name: str) -> Row | None:
    """As it was decided last."""
    return last_of(connection, INTERVAL, "equipment", name)


def setting(connection: Connection, name: str, default: str) -> str:
    """What was said last, else the default."""
    row = last_of(connection, SETTING, "name", name)
    return default if row is None else str(row["value"])
