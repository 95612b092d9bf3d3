"""When equipment must come back, as somebody decided."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import INTERVAL


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """One."""
    names = ("days", "method", "from_at", "due_at", "why")
    yield INTERVAL, {"equipment": entry.subject, **{name: entry.stated.get(name) for name in names}}


ACT = Act("interval", "interval", rows)
