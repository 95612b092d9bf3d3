"""A file of Ulna's formats, or any other, that belongs to an arm: what it says of it."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row, of_files
from ulna.records.entry import Entry
from ulna.records.filed.kind import About
from ulna.records.filed.registry import kind_named
from ulna.records.store import Store
from ulna.records.tables import USED

MAIN = "file"
"""What the file itself is to the act; others came with it."""


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """What its format says; which artefacts of the record it leaned on; the files."""
    stated, sha256 = entry.stated, entry.files[MAIN]
    about = About(entry.subject, sha256, stated["at"])
    yield from kind_named(stated["kind"]).rows(files.get(sha256), about)
    for artefact in stated.get("artefacts", ()):
        yield USED, {"sha256": sha256, "arm": entry.subject, "artefact": artefact, "at": stated["at"]}
    yield from of_files(entry)


ACT = Act("filed", "filed", rows)
