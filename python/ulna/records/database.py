"""The database of a bench: SQLite in its folder, or PostgreSQL by URL. Many read, one writes at a time."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError, DBAPIError, OperationalError, SQLAlchemyError
from sqlalchemy.pool import NullPool

from ulna.ground.errors import UlnaInputError
from ulna.records.server import engine_of_server

WAIT_S = 60.0
"""For the one that writes."""
PASSWORD = "PGPASSWORD"
"""In the environment, as PostgreSQL's own programs have it."""
_LOCK = 0x756C6E61
"""PostgreSQL's number of the lock that whoever writes holds: "ulna"."""
_BEGIN_READING = {"sqlite": "BEGIN", "postgresql": "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY"}
_BEGIN_WRITING = {
    "sqlite": "BEGIN IMMEDIATE",
    "postgresql": f"BEGIN; SET LOCAL lock_timeout = '{WAIT_S:.0f}s'; SELECT pg_advisory_xact_lock({_LOCK})",
}
_BROKEN = ("malformed", "not a database", "no UTF-8")
"""What SQLite says of a file that is damaged."""
_READ_ONLY = "readonly database"
_BUSY = ("database is locked", "database is busy", "'55P03'")
"""What SQLite says where another writes, and PostgreSQL's code for that, in every language."""


def engine_of(url: str) -> Engine:
    """A door to it; nothing is opened yet. Raises UlnaInputError for a URL of another kind of database."""
    made = _checked(url)
    # transactions are begun by hand: Python's own way begins them too late
    # and no connection is kept, so that a bench can be moved and a server started anew
    if made.get_backend_name() == "sqlite":
        engine = create_engine(made, poolclass=NullPool, connect_args={"isolation_level": None, "timeout": WAIT_S})
        event.listen(engine, "connect", _set_up)
        return engine
    return engine_of_server(made, os.environ.get(PASSWORD), WAIT_S + 10)


def _checked(url: str) -> URL:
    try:
        made = make_url(url)
        backend = made.get_backend_name()
    except (ArgumentError, ValueError):
        raise UlnaInputError(
            f"database {_shown(url)}: no URL; expected postgresql://user@host/name. Correct it."
        ) from None
    if backend not in ("sqlite", "postgresql"):
        raise UlnaInputError(
            f"database {_shown(url)}: a database of kind '{backend}'; expected postgresql://user@host/name, or none: "
            "then it is SQLite in the folder."
        )
    if made.password is not None:
        raise UlnaInputError(
            f"database {_shown(url)}: a password in the URL, which the record would keep in plain text; expected "
            f"postgresql://user@host/name. Give it in the environment: {PASSWORD}."
        )
    if made.query:
        raise UlnaInputError(
            f"database {_shown(url)}: options behind a question mark; expected "
            "postgresql://user@host/name alone. Leave them out."
        )
    return made


def _shown(url: str) -> str:
    """Without what comes before the host and behind the name, which may be a password."""
    return url.rsplit("@", 1)[-1].split("?")[0][:80]


def _set_up(connection: sqlite3.Connection, _: Any) -> None:
    """On the disk before it is said to be done; readers beside the one that writes."""
    for pragma in ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON", "trusted_schema = OFF"):
        connection.execute(f"PRAGMA {pragma}")


def check_server(url: str) -> None:
    """Raises UlnaInputError for what is no server: a record's own SQLite is in its folder, and no other is opened."""
    if _checked(url).get_backend_name() != "postgresql":
        raise UlnaInputError(
            f"database {_shown(url)}: a file; expected postgresql://user@host/name, or none: then it is SQLite in the "
            "folder."
        )


class DamagedDatabaseError(UlnaInputError):
    """A file that is no database any more: it can be put aside, as nobody can write to it."""


class Database:
    """Where the chain and the index are."""

    def __init__(self, url: str) -> None:
        self.url = url
        self.engine = engine_of(url)

    @property
    def sqlite(self) -> bool:
        """Whether it is a file of the bench."""
        return self.engine.dialect.name == "sqlite"

    @property
    def _named(self) -> str:
        """For messages: the file, or where the server has it."""
        return str(self.engine.url.database) if self.sqlite else _shown(self.url)

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """What all saw at one moment. Raises UlnaInputError where it cannot be asked."""
        with self._said(), self.engine.connect() as connection:
            connection.execute(text(_BEGIN_READING[self.engine.dialect.name]))
            try:
                yield connection
            finally:
                with suppress(SQLAlchemyError):
                    connection.execute(text("ROLLBACK"))

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """The one that writes: all of it or nothing. Raises UlnaInputError where it cannot be written."""
        with self._said(), self.engine.connect() as connection:
            connection.execute(text(_BEGIN_WRITING[self.engine.dialect.name]))
            try:
                yield connection
            except BaseException:
                with suppress(SQLAlchemyError):  # of a connection that was lost nothing is kept anyway
                    connection.execute(text("ROLLBACK"))
                raise
            self._commit(connection)

    def _commit(self, connection: Connection) -> None:
        """Raises UlnaInputError where a server's answer is lost: then it may have been done."""
        try:
            connection.execute(text("COMMIT"))
        except DBAPIError as error:
            if self.sqlite:
                raise
            raise UlnaInputError(
                f"database {self._named}: the connection was lost while the last entry was being kept "
                f"({_words(error)}): it is there whole, or nothing of it is. See that the server runs, and what ulna "
                "record history says before you do it again."
            ) from None

    @contextmanager
    def _said(self) -> Iterator[None]:
        """What the database says, in words."""
        try:
            yield
        except OperationalError as error:
            raise self._unusable(error) from None
        except DBAPIError as error:
            if not self.sqlite or isinstance(error.orig, sqlite3.DatabaseError):
                raise self._unusable(error) from None
            raise
        except UnicodeDecodeError:  # SQLite's own words about a damaged file quote what is in it
            if not self.sqlite:
                raise
            raise self._damaged("its text is no UTF-8") from None

    def _unusable(self, error: DBAPIError) -> UlnaInputError:
        said = " ".join(_words(error).split())[:200]
        if any(each in str(error.orig) for each in _BUSY):
            return UlnaInputError(
                f"database {self._named}: another program has been writing to it for {WAIT_S:.0f} s. Try again."
            )
        if self.sqlite and _READ_ONLY in said:
            return UlnaInputError(
                f"database {self._named}: may not be written by you, and whoever only looks has to write beside it as "
                "well (its locks); expected a folder that you may write in. Ask whoever keeps the record for that, or "
                "make one of your own from a backup: ulna record import ZIP DIR."
            )
        return self._damaged(said)

    def _damaged(self, said: str) -> UlnaInputError:
        words = f"database {self._named}: cannot be used ({said}). See that it is there and whole."
        if self.sqlite and any(each in said for each in _BROKEN):
            return DamagedDatabaseError(f"{words} If its files are whole: ulna record rebuild.")
        return UlnaInputError(words)


def _words(error: DBAPIError) -> str:
    told = error.orig.args[0] if error.orig is not None and error.orig.args else str(error)
    return str(told.get("M", told)) if isinstance(told, dict) else str(told)
