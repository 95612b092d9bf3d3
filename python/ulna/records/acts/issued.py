"""A certificate that left the house."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row, of_files
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import CERTIFICATE, STANDING


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """The certificate; it is in force, and one that it supersedes no longer."""
    stated = entry.stated
    yield (
        CERTIFICATE,
        {
            "number": entry.subject,
            "arm": stated["arm"],
            "sha256": entry.files["certificate"],
            "of": entry.files.get("result"),
            "issued_at": stated["issued_at"],
            "issued_by": entry.actor,
            "approved_by": stated.get("approved_by"),
            "supersedes": stated.get("supersedes"),
            "head": entry.previous,
        },
    )
    yield STANDING, {"subject": entry.subject, "state": "in force", "reason": "issued"}
    if stated.get("supersedes"):
        reason = f"superseded by {entry.subject}: {stated['reason']}"
        yield STANDING, {"subject": stated["supersedes"], "state": "superseded", "reason": reason}
    yield from of_files(entry)


ACT = Act("issued", "issued", rows)
