"""The chain of entries: in the database, where triggers keep it, and each entry as a file of its own.

An entry is in the database first, so that no file of an entry is left by a write that was cut off: a file whose entry
is not in the database has been taken out of it. The newest entry's file may lack after a cut; whoever comes next writes
it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from itertools import takewhile
from typing import Any

from sqlalchemy import Connection, insert, select

from ulna.records.entry import FIRST, Entry
from ulna.records.projection import rows_of
from ulna.records.store import Store, sha256_of
from ulna.records.tables import ENTRY

_CUT = 1000
"""Entries that one write may make."""


def now() -> str:
    """ISO 8601, UTC."""
    return datetime.now(UTC).isoformat(timespec="microseconds")


def head(connection: Connection) -> tuple[int, str]:
    """Number and SHA-256 of the newest entry; 0 and "" of none."""
    row = connection.execute(select(ENTRY.c.seq, ENTRY.c.sha256).order_by(ENTRY.c.seq.desc()).limit(1)).first()
    return (0, FIRST) if row is None else (row[0], row[1])


def append(
    connection: Connection,
    files: Store,
    after: tuple[int, str],
    actor: str,
    act: str,
    subject: str,
    stated: Mapping[str, Any],
    named: Mapping[str, str],
) -> Entry:
    """The entry after the newest one, and the rows that follow from it, in a transaction that writes; its file comes
    after. Raises UlnaInputError where a file that it names cannot be read."""
    seq, previous = after
    entry = Entry(seq + 1, now(), actor, act, subject, stated, named, previous)
    take(connection, files, entry)
    return entry


def take(connection: Connection, files: Store, entry: Entry) -> None:
    """An entry as it stands, and its rows. Raises UlnaInputError where a file that it names cannot be read."""
    connection.execute(insert(ENTRY), [row_of(entry)])
    index(connection, files, entry)


def index(connection: Connection, files: Store, entry: Entry) -> None:
    """The rows that follow from an entry. Raises UlnaInputError where a file that it names cannot be read."""
    for table, rows in rows_of(entry, files).items():
        connection.execute(insert(table), rows)


def row_of(entry: Entry) -> dict[str, Any]:
    """As the database has it."""
    return {
        "seq": entry.seq,
        "at": entry.at,
        "actor": entry.actor,
        "act": entry.act,
        "subject": entry.subject,
        "previous": entry.previous,
        "sha256": entry.sha256,
        "text": entry.text,
    }


def settle(connection: Connection, links: Store) -> tuple[int, str]:
    """The files of the newest entries, where they are not there yet: the oldest first, so that a cut leaves no gap.
    Number and SHA-256 of the newest entry."""
    end = head(connection)
    if end[1] == FIRST or links.place(end[1]).exists():
        return end
    newest = select(ENTRY.c.text, ENTRY.c.sha256).order_by(ENTRY.c.seq.desc()).limit(_CUT)
    absent = takewhile(lambda row: not links.place(row[1]).exists(), connection.execute(newest))
    for text, name in reversed(list(absent)):
        if sha256_of(text.encode()) == name:  # else it was changed, and no file of that name can be made
            links.put(text.encode())
    return end


def walk(connection: Connection, **only: str) -> Iterator[Entry]:
    """The entries, the first one first; `only`: those of an act, a subject, an actor."""
    chosen = select(ENTRY.c.text).order_by(ENTRY.c.seq)
    for column, value in only.items():
        chosen = chosen.where(ENTRY.c[column] == value)
    for (text,) in connection.execute(chosen):
        yield Entry.of_text(text)
