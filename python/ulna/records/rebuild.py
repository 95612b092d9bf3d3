"""The database made anew: from the files of the entries, and the originals."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from sqlalchemy import Connection, delete, inspect, text

from ulna.ground.errors import UlnaInputError
from ulna.records import chain, triggers
from ulna.records.bench import Bench
from ulna.records.database import DamagedDatabaseError
from ulna.records.entry import FIRST, Entry
from ulna.records.place import DATABASE
from ulna.records.schema import upgrade
from ulna.records.store import Store
from ulna.records.tables import ENTRY, INDEX, METADATA


def rebuild(bench: Bench) -> int:
    """Makes the tables anew; the number of entries. A database file that is damaged is put aside, never deleted.

    Raises UlnaInputError where the entries' files are not one chain, or an original is not there: nothing is changed
    then.
    """
    try:
        return _anew(bench)
    except DamagedDatabaseError:
        if not bench.database.sqlite or not _aside(bench.folder / DATABASE):
            raise
        return _anew(bench)


def _anew(bench: Bench) -> int:
    with bench.database.writing() as connection:
        # while nobody else writes, and with the files that a cut, or another program just now, has not made yet: what
        # came in between would be lost
        if inspect(connection).has_table(ENTRY.name):
            chain.settle(connection, bench.links)
        entries = chained(bench.links)
        if not entries and next(bench.files.names(), None) is not None:
            raise UlnaInputError(
                f"{bench.links.folder}: has no entry, and {bench.files.folder} has files that one must have named; "
                "expected the files of entries. Restore them from a backup."
            )
        _check(bench.files, entries)
        _drop(connection)
        upgrade(connection)
        for entry in entries:
            chain.take(connection, bench.files, entry)
    return len(entries)


def index_anew(connection: Connection, files: Store) -> None:
    """Every row of the index anew, from the chain as it stands in the database. Raises UlnaInputError where a file that
    it names is not there."""
    triggers.unguard(connection, [table.name for table in INDEX])
    for table in INDEX:
        connection.execute(delete(table))
    for entry in list(chain.walk(connection)):
        chain.index(connection, files, entry)
    triggers.guard(connection, METADATA.tables)


def _drop(connection: Connection) -> None:
    present = set(inspect(connection).get_table_names())
    for name in [*METADATA.tables, "alembic_version"]:
        if name in present:
            connection.execute(text(f'DROP TABLE "{name}"'))


def _aside(path: Path) -> bool:
    """Whether there was a file to be put aside."""
    if not path.is_file():
        return False
    aside = next(
        each for n in range(1, 10_000) if not (each := path.with_name(f"{path.stem}-damaged-{n}{path.suffix}")).exists()
    )
    for suffix in ("", "-wal", "-shm"):
        beside = path.with_name(path.name + suffix)
        if beside.exists():
            beside.rename(aside.with_name(aside.name + suffix))
    return True


def chained(links: Store) -> list[Entry]:
    """The entries of a folder, in order. Raises UlnaInputError where they are not one chain."""
    entries = [entry_of(links.get(name), str(links.place(name))) for name in links.names()]
    return in_order(entries, str(links.folder))


def entry_of(content: bytes, where: str) -> Entry:
    """Raises UlnaInputError for a file that is no entry."""
    try:
        return Entry.of_text(content.decode())
    except ValueError as error:
        raise UlnaInputError(f"{where}: no entry ({error}). Restore it from a backup.") from None


def in_order(entries: Iterable[Entry], where: str) -> list[Entry]:
    """Raises UlnaInputError where they are not one chain."""
    ordered = sorted(entries, key=lambda entry: entry.seq)
    previous = FIRST
    for number, entry in enumerate(ordered, start=1):
        if entry.seq != number or entry.previous != previous:
            raise UlnaInputError(
                f"{where}: entry {number} is not there, or there are two of it: the files of entries are not one "
                "chain. See what ulna record verify says, and restore a backup."
            )
        previous = entry.sha256
    return ordered


def _check(files: Store, entries: Iterable[Entry]) -> None:
    for entry in entries:
        for sha256 in entry.files.values():
            files.get(sha256)
