"""A record that is open: its files, its chain, its database, and who works with it."""

from __future__ import annotations

import getpass
import os
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sqlalchemy import Connection

from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.records import chain
from ulna.records.database import Database, check_server
from ulna.records.entry import Entry
from ulna.records.place import FILES, LINKS, WHO, bench_file, found, make_folder, settings, unmade, url_of
from ulna.records.schema import check_schema, upgrade
from ulna.records.store import Store

_LONGEST = 200


@dataclass
class Writing:
    """What is being written: all of it or nothing."""

    connection: Connection
    bench: Bench
    head: tuple[int, str]
    """Number and SHA-256 of the newest entry: nobody else writes meanwhile."""
    entries: list[Entry] = field(default_factory=list)

    def add(self, act: str, subject: str, stated: Mapping[str, Any], files: Mapping[str, str] | None = None) -> Entry:
        """The next entry. Files are in the store already."""
        bench = self.bench
        entry = chain.append(self.connection, bench.files, self.head, bench.by, act, subject, stated, files or {})
        self.head = entry.seq, entry.sha256
        self.entries.append(entry)
        return entry


class Bench:
    """A bench folder and its database."""

    def __init__(self, folder: Path, by: str | None = None) -> None:
        """Opens nothing yet but `bench.toml`. Raises UlnaInputError."""
        self.folder = folder
        self.by = _checked(by or os.environ.get(WHO) or settings().by or _login())
        file = bench_file(folder)
        if file.database is not None:
            check_server(file.database)
        self.database = Database(url_of(folder, file))
        self.files = Store(folder / FILES)
        self.links = Store(folder / LINKS)

    @classmethod
    def make(cls, folder: Path, database: str | None = None, by: str | None = None) -> Bench:
        """A new record. Raises UlnaInputError where there is something already."""
        if database is not None:
            check_server(database)  # a URL of something else is said before anything is made
        there = folder.exists()
        make_folder(folder, database)
        try:
            return cls._empty(folder, by)
        except BaseException:
            unmade(folder, there)
            raise

    @classmethod
    def _empty(cls, folder: Path, by: str | None) -> Bench:
        """With the tables of a record. Raises UlnaInputError where the database has some."""
        bench = cls(folder, by)
        with bench.database.writing() as connection:
            from sqlalchemy import inspect

            if inspect(connection).get_table_names():
                raise UlnaInputError(
                    f"{folder}: the database has tables already; expected an empty one. Name another with --database."
                )
            upgrade(connection)
        return bench

    @classmethod
    def open(cls, folder: str | os.PathLike[str] | None = None, by: str | None = None) -> Bench:
        """As named, else as the environment or the settings say. Raises UlnaInputError for what is no record, or one
        of another schema."""
        bench = cls(found(folder), by)
        with bench.reading():
            return bench

    def worked_by(self, name: str) -> Bench:
        """The same bench, with somebody else at work. Raises UlnaInputError for what is no name."""
        other = copy(self)
        other.by = _checked(name)
        return other

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """To ask."""
        with self.database.reading() as connection:
            check_schema(connection, self.folder)
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Writing]:
        """To add to it: when the block ends without an error, all of it is on the disk. Raises UlnaInputError."""
        with self.database.writing() as connection:
            check_schema(connection, self.folder)
            doing = Writing(connection, self, chain.settle(connection, self.links))
            yield doing
        try:
            for entry in doing.entries:
                self.links.put(entry.text.encode())
        except OSError as error:
            warnings.warn(
                f"{self.links.folder}: entry {doing.entries[-1].seq} is in the database, its file could not be written "
                f"({error.strerror or error}). Do not repeat it: the next that writes makes the file.",
                InputWarning,
                stacklevel=2,
            )


def _login() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return "unknown"


def _checked(name: str) -> str:
    return checked_text(name, "option --by")


def checked_text(text: str, what: str, longest: int = _LONGEST) -> str:
    """A name or a line, with anything in it that can be printed. Raises UlnaInputError."""
    kept = text.strip()
    if not kept or len(kept) > longest or not kept.isprintable():
        raise UlnaInputError(
            f"{what}: got {text[:60]!r}, expected 1 to {longest} letters that can be printed. Correct it."
        )
    try:
        kept.encode()
    except UnicodeEncodeError:
        raise UlnaInputError(f"{what}: got {text[:60]!r}, which is no UTF-8. Correct it.") from None
    return kept
