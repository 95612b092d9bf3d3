"""What happened to equipment: a knock, a repair, a move."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.ground.worded import templates
from ulna.records.acts.act import Act, Row, of_files
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import EVENT

KINDS = ("knock", "repair", "move", "adjustment", "firmware", "quarantine", "release", "note")
BREAKS = ("adjustment", "repair", "firmware")
"""Events after which an arm may be another one: what was before is as found, what comes after as left."""
BREAK_WORDS = templates("adjustment", "repair", "firmware")
"""The same, as sentences have them."""
STATE_AFTER = {"quarantine": "quarantined", "release": "in use"}
"""Events that change whether equipment may be used."""


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """One."""
    stated = entry.stated
    yield EVENT, {"equipment": entry.subject, "kind": stated["kind"], "at": stated["at"], "text": stated["text"]}
    yield from of_files(entry)


ACT = Act("event", "happened", rows)
