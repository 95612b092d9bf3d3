"""From the schema of one version of Ulna to that of the next, by Alembic: in one transaction, triggers kept."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from sqlalchemy import Connection, inspect, text
from sqlalchemy.exc import DBAPIError

from ulna.ground.errors import UlnaInputError
from ulna.records import triggers
from ulna.records.tables import METADATA

NEWEST = "r0001"
"""The schema that this Ulna reads and writes: the last of `migrations/versions`."""
_KEPT = "alembic_version"
_NOT_THERE = ("no such table", "'42P01'")
"""What SQLite says of a table that is not there, and PostgreSQL's code for that, in every language."""


def schema_of(connection: Connection) -> str | None:
    """The version that a database has; None of an empty one: then a transaction of PostgreSQL does nothing more."""
    try:
        found = connection.scalar(text(f"SELECT version_num FROM {_KEPT}"))
    except DBAPIError as error:  # asking first whether it is there would take longer than all else
        if not any(each in str(error.orig) for each in _NOT_THERE):
            raise
        return None
    return None if found is None else str(found)


def check_schema(connection: Connection, where: Path) -> None:
    """Raises UlnaInputError where a database is of another version."""
    check_version(schema_of(connection), where)


def check_version(found: str | None, where: Path) -> None:
    """Raises UlnaInputError for a version that is not this one's; None: of an empty database."""
    if found == NEWEST:
        return
    if found is None:
        raise UlnaInputError(
            f"{where}: the database is empty; expected a record. If its files are whole: ulna record rebuild."
        )
    if found < NEWEST:
        raise UlnaInputError(
            f"{where}: the database has schema {found}, this Ulna {NEWEST}. Run: ulna record migrate (it makes a "
            "backup first)."
        )
    raise UlnaInputError(f"{where}: the database has schema {found}, which this Ulna does not know. Use a newer Ulna.")


def upgrade(connection: Connection, versions: Path | None = None) -> None:
    """To the newest schema, within the transaction of the connection. versions: a folder of others, for tests."""
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(files("ulna.records") / "migrations"))
    if versions is not None:
        config.set_main_option("path_separator", "newline")
        config.set_main_option("version_locations", str(versions))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")
    # batches of SQLite copy tables and drop their triggers
    triggers.guard(connection, [table for table in inspect(connection).get_table_names() if table in METADATA.tables])
