"""Whether the record is what was written: the chain link by link, files by their hashes, rows by what they follow from.

What is found is said with the thing and its place. An entry taken out and the chain linked anew is found by the files
of entries that are no longer in it, and by heads that stand elsewhere: on certificates that were issued, and wherever
somebody noted one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from itertools import takewhile
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Table, inspect, select

from ulna.ground.errors import UlnaInputError
from ulna.records import chain, triggers
from ulna.records.bench import Bench
from ulna.records.entry import FIRST, Entry
from ulna.records.projection import rows_of
from ulna.records.store import Store
from ulna.records.tables import CERTIFICATE, ENTRY, INDEX, METADATA

CLOCK = timedelta(minutes=10)
"""By so much may clocks of several machines differ: an entry earlier than the one before by more was dated back."""


@dataclass(frozen=True)
class Verified:
    """What was looked at, and what is wrong."""

    entries: int
    files: int
    rows: int
    head: str
    """Of the chain: "seq:SHA-256", to be noted elsewhere."""
    wrong: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    """What is no fault, such as files that an interrupted command left."""

    @property
    def good(self) -> bool:
        """Whether nothing is wrong."""
        return not self.wrong


def verify(bench: Bench, heads: Sequence[str] = ()) -> Verified:
    """All of it. heads: "seq:SHA-256" as noted elsewhere. Raises UlnaInputError where nothing can be read."""
    with bench.reading() as connection:
        wrong, remarks = list[str](), list[str]()
        absent = set(METADATA.tables) - set(inspect(connection).get_table_names())
        wrong += [f"table {name} is not there" for name in sorted(absent)]
        lost = triggers.missing(connection, METADATA.tables)
        wrong += [f"trigger {name} is not there: rows can be changed" for name in lost]
        if absent:
            return Verified(0, 0, 0, "", wrong, remarks)
        entries = list(_links(connection, wrong))
        wrong += _files_of_entries(bench.links, entries)
        named = _files(bench.files, entries, wrong)
        remarks += _beside(bench.files, named)
        if cut := _cut_off(bench.links, entries):
            remarks.append(f"{cut} of the newest entries without a file in the chain's folder: the next write makes it")
        rows = _rows(connection, bench.files, entries, wrong)
        wrong += _heads(connection, entries, heads)
        seq, sha256 = chain.head(connection)
        return Verified(len(entries), len(named), rows, f"{seq}:{sha256}", wrong, remarks)


def _links(connection: Connection, wrong: list[str]) -> Iterator[Entry]:
    """The entries that can be read, each looked at with the one before."""
    previous, seq, at = FIRST, 0, None
    for row in connection.execute(select(ENTRY).order_by(ENTRY.c.seq)):
        seq += 1
        if row.seq != seq:
            wrong.append(f"entry {seq} is not there: the chain goes on with {row.seq}")
            seq = row.seq
        try:
            entry = Entry.of_text(row.text)
        except ValueError as error:
            wrong.append(f"entry {seq} was changed: its text is no entry ({error})")
            previous = row.sha256
            continue
        changed = [key for key, value in chain.row_of(entry).items() if row._mapping[key] != value]
        if changed:
            wrong.append(f"entry {seq} was changed: {', '.join(changed)} not as its text says")
        if entry.previous != previous:
            wrong.append(f"entry {seq} does not follow from the entry before: the chain is cut here")
        when = _time(entry.at)
        if when is None or (at is not None and when < at - CLOCK):
            wrong.append(f"entry {seq} is dated {entry.at}, before the entry that it follows")
        at = when or at
        previous = row.sha256
        yield entry


def _time(said: str) -> datetime | None:
    try:
        return datetime.fromisoformat(said)
    except ValueError:
        return None


def _files_of_entries(links: Store, entries: Sequence[Entry]) -> Iterator[str]:
    by_name = {entry.sha256: entry for entry in entries}
    for name in links.names():
        text, said = links.place(name).read_bytes(), f"file of an entry {name[:12]}…"
        if name not in by_name:
            yield f"{said} is of no entry in the chain ({_about(text)}): it was taken out, or the chain linked anew"
        elif text.decode(errors="replace") != by_name[name].text:
            yield f"{said} (entry {by_name[name].seq}) was changed"
    missing = [entry.seq for entry in entries if not links.place(entry.sha256).exists()]
    without = len(missing) - _cut_off(links, entries)
    yield from (f"entry {seq} has no file in the chain's folder" for seq in missing[:without])


def _cut_off(links: Store, entries: Sequence[Entry]) -> int:
    """How many of the newest entries have no file yet: of a write that was cut off before it made them. Where none of
    several has one, somebody took them away."""
    found = sum(1 for _ in takewhile(lambda entry: not links.place(entry.sha256).exists(), reversed(entries)))
    return found if found < len(entries) or found == 1 else 0


def _about(text: bytes) -> str:
    try:
        entry = Entry.of_text(text.decode())
    except ValueError:
        return "it cannot be read"
    return f"entry {entry.seq}: {entry.act} {entry.subject}, {entry.at}"


def _files(files: Store, entries: Sequence[Entry], wrong: list[str]) -> dict[str, int]:
    """SHA-256 of each file that an entry names → the first such entry; each is read."""
    named: dict[str, int] = {}
    for entry in entries:
        for role, sha256 in entry.files.items():
            if named.setdefault(sha256, entry.seq) == entry.seq:
                try:
                    files.get(sha256)
                except UlnaInputError as error:
                    wrong.append(f"entry {entry.seq} ({entry.act} {entry.subject}), {role}: {error}")
                except (OSError, ValueError) as error:
                    wrong.append(f"entry {entry.seq} ({entry.act} {entry.subject}), {role}: cannot be read ({error})")
    return named


def _beside(files: Store, named: dict[str, int]) -> Iterator[str]:
    left = [name for name in files.names() if name not in named]
    if left:
        yield (
            f"{len(left)} file{'s' * (len(left) != 1)} in the store of which no entry speaks ({left[0][:12]}…): "
            "left by a command that was cut off, or refused"
        )


def _rows(connection: Connection, files: Store, entries: Sequence[Entry], wrong: list[str]) -> int:
    """How many rows follow from the entries; what the database has beside them, or has not, is wrong."""
    expected: dict[Table, dict[tuple[int, int], dict[str, Any]]] = {table: {} for table in INDEX}
    unknown = set[int]()
    for entry in entries:
        try:
            made = rows_of(entry, files)
        except (UlnaInputError, LookupError, TypeError, ValueError, OSError):
            unknown.add(entry.seq)  # nobody knows what its rows should be: none of them was shown to be wrong
            wrong.append(f"entry {entry.seq}: its rows cannot be made anew, as its files are not what they were")
            continue
        for table, rows in made.items():
            expected[table].update({(row["seq"], row["line"]): row for row in rows})
    for table in INDEX:
        wrong += _differences(connection, table, expected[table], unknown)
    return sum(map(len, expected.values()))


def _differences(
    connection: Connection, table: Table, expected: dict[tuple[int, int], dict[str, Any]], unknown: set[int]
) -> Iterator[str]:
    left = dict(expected)
    for row in connection.execute(select(table)):
        found = dict(row._mapping)
        key = (found["seq"], found["line"])
        due = left.pop(key, None)
        where = f"table {table.name}, row {key[0]}.{key[1]}"
        if due is None and key[0] in unknown:
            continue
        if due is None:
            yield f"{where} follows from no entry: it was added"
        elif due != found:
            changed = ", ".join(name for name in due if due[name] != found[name])
            yield f"{where} was changed: {changed} not as entry {key[0]} says"
    for key in left:
        yield f"table {table.name}, row {key[0]}.{key[1]} is not there: it was deleted"


def _heads(connection: Connection, entries: Sequence[Entry], heads: Sequence[str]) -> Iterator[str]:
    known = {f"{entry.seq}:{entry.sha256}" for entry in entries}
    names = {entry.sha256 for entry in entries} | {FIRST}
    for head in heads:
        if head not in known:
            yield f"head {head[:24]}… is not in the chain: what was written until then is no longer as it was"
    for number, head in connection.execute(select(CERTIFICATE.c.number, CERTIFICATE.c.head)):
        if head not in names:
            yield f"certificate {number} carries the head {head[:12]}…, which is not in the chain"


def heads_in(path: Path) -> list[str]:
    """Of a file that lists them, one a line. Raises UlnaInputError."""
    from ulna.formats.toml import read_bytes

    lines = read_bytes(path, "a list of heads").decode(errors="replace").split()
    for line in lines:
        check_head(line, str(path))
    return lines


def check_head(head: str, what: str) -> None:
    """Raises UlnaInputError for what is none."""
    seq, _, sha256 = head.partition(":")
    if not (seq.isdigit() and len(sha256) == 64 and all(each in "0123456789abcdef" for each in sha256)):
        raise UlnaInputError(
            f"{what}: got '{head[:60]}', expected a head such as 17:3f… with 64 hex digits. Correct it."
        )
