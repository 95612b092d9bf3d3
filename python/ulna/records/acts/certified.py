"""What a certificate says of an artefact: its values, their uncertainties, and how long they are relied on."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row, of_files
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import CERTIFIED

ALL = ("number", "by", "valid_from", "valid_to", "temperature_c", "expansion_per_k", "expansion_u_per_k")


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """One for each value."""
    common = {name: entry.stated.get(name) for name in ALL}
    for value in entry.stated["values"]:
        yield (
            CERTIFIED,
            {
                "artefact": entry.subject,
                "quantity": value["quantity"],
                "unit": value["unit"],
                "value": value["value"],
                "u": value["u"],
                "sha256": entry.files.get("certificate"),
                **common,
            },
        )
    yield from of_files(entry)


ACT = Act("certified", "certified", rows)
