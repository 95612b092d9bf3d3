"""Somebody who works with the record, and in which roles."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import PERSON

ROLES = ("reader", "operator", "reviewer", "admin")


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """One; no role: gone."""
    yield PERSON, {"name": entry.subject, "roles": " ".join(entry.stated["roles"])}


ACT = Act("person", "registered", rows)
