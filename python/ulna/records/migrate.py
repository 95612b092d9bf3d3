"""A record of an earlier Ulna as one of this."""

from __future__ import annotations

from pathlib import Path

from ulna.records import schema
from ulna.records.bench import Bench
from ulna.records.copies import Copied, backup
from ulna.records.rebuild import index_anew


def migrate(bench: Bench, backup_to: Path) -> Copied | None:
    """To the newest schema, after a backup into a folder; None where it has it. The chain stays as it is, the index is
    made anew from it, all in one transaction. Raises UlnaInputError."""
    with bench.database.reading() as connection:
        found = schema.schema_of(connection)
        if found == schema.NEWEST:
            return None
        if found is None or found > schema.NEWEST:
            schema.check_version(found, bench.folder)
    copied = backup(bench, backup_to)
    with bench.database.writing() as connection:
        schema.upgrade(connection)
        index_anew(connection, bench.files)
    return copied
