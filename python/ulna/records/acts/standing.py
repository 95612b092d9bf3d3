"""Whether a certificate or a filed result still stands, and why not."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import STANDING

WITHDRAWN = "withdrawn"


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """One."""
    yield STANDING, {"subject": entry.subject, "state": entry.stated["state"], "reason": entry.stated["reason"]}


ACT = Act("standing", "changed", rows)
