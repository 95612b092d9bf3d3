"""What makes every table one that only grows: the database itself refuses to change or to delete a row."""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Connection, text

_MESSAGE = "the record only grows: rows are neither changed nor deleted"
_PER_EVENT = {
    "sqlite": ("CREATE TRIGGER {name} BEFORE {event} ON {table} BEGIN SELECT RAISE(ABORT, '" + _MESSAGE + "'); END"),
    "postgresql": "CREATE TRIGGER {name} BEFORE {event} ON {table} FOR EACH ROW EXECUTE FUNCTION ulna_only_grows()",
}
_BEFORE = {
    "sqlite": (),
    "postgresql": (
        "CREATE OR REPLACE FUNCTION ulna_only_grows() RETURNS trigger LANGUAGE plpgsql AS "
        f"$$ BEGIN RAISE EXCEPTION '{_MESSAGE}'; END $$",
    ),
}
_DROP = {"sqlite": "DROP TRIGGER {name}", "postgresql": "DROP TRIGGER {name} ON {table}"}
_PRESENT = {
    "sqlite": "SELECT name FROM sqlite_master WHERE type = 'trigger'",
    "postgresql": "SELECT tgname FROM pg_trigger WHERE NOT tgisinternal AND tgenabled <> 'D'",
}


def _names(tables: Iterable[str]) -> dict[str, tuple[str, str]]:
    return {f"{table}_no_{event.lower()}": (table, event) for table in tables for event in ("UPDATE", "DELETE")}


def guard(connection: Connection, tables: Iterable[str]) -> None:
    """Make the triggers of these tables that are not there."""
    dialect = connection.dialect.name
    for statement in _BEFORE[dialect]:
        connection.execute(text(statement))
    present = _present(connection)
    for name, (table, event) in _names(tables).items():
        if name in present:
            continue
        connection.execute(text(_PER_EVENT[dialect].format(name=name, event=event, table=f'"{table}"')))


def unguard(connection: Connection, tables: Iterable[str]) -> None:
    """Take them away within a transaction that makes the index anew."""
    present = _present(connection)
    for name, (table, _) in _names(tables).items():
        if name in present:
            connection.execute(text(_DROP[connection.dialect.name].format(name=name, table=f'"{table}"')))


def missing(connection: Connection, tables: Iterable[str]) -> list[str]:
    """Triggers that are not there, or are switched off."""
    present = _present(connection)
    return [name for name in _names(tables) if name not in present]


def _present(connection: Connection) -> set[str]:
    return set(connection.scalars(text(_PRESENT[connection.dialect.name])))
