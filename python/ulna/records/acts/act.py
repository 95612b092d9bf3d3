"""What an act owes: the rows that follow from its entry."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Table

from ulna.records.entry import Entry
from ulna.records.store import Store

Row = tuple[Table, dict[str, Any]]


@dataclass(frozen=True)
class Act:
    """A kind of entry."""

    name: str
    said: str
    """In words, as lists have it: "filed"."""
    rows: Callable[[Entry, Store], Iterator[Row]]
    """In the same order each time; what is not given is null."""


def of_files(entry: Entry) -> Iterator[Row]:
    """Each file that an entry names."""
    from ulna.records.tables import FILE

    names, formats = entry.stated.get("names", {}), entry.stated.get("formats", {})
    for role, sha256 in sorted(entry.files.items()):
        yield FILE, {"sha256": sha256, "name": names.get(role), "format": formats.get(role), "role": role}
