"""Equipment as it is from now on: an arm, a probe, an artefact, a thermometer, a robot. The newest row holds."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.records.acts.act import Act, Row, of_files
from ulna.records.entry import Entry
from ulna.records.store import Store
from ulna.records.tables import EQUIPMENT

KINDS = ("arm", "robot", "probe", "artefact", "thermometer")
STATES = ("in use", "quarantined", "retired")
DETAILS = ("part_of", "maker", "model", "serial", "firmware", "owner", "location", "remark")


def rows(entry: Entry, files: Store) -> Iterator[Row]:
    """The whole of it."""
    stated = entry.stated
    details = {name: stated.get(name) for name in DETAILS}
    yield EQUIPMENT, {"name": entry.subject, "kind": stated["kind"], "state": stated["state"], **details}
    yield from of_files(entry)


ACT = Act("equipment", "registered", rows)
