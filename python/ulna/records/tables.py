"""The tables of the database: the chain, and the index that follows from it. Rows are only ever added.

Every row of the index has the number of the entry that it follows from and its own number among that entry's rows; of
what changes with time (equipment, standing, interval) the newest row holds. Times are ISO 8601 in UTC, as text.
"""

from __future__ import annotations

from typing import Any

from sqlalchemy import Boolean, Column, Double, Index, Integer, MetaData, String, Table, Text

METADATA = MetaData()

ENTRY = Table(
    "entry",
    METADATA,
    Column("seq", Integer, primary_key=True, autoincrement=False),
    Column("at", String, nullable=False),
    Column("actor", String, nullable=False),
    Column("act", String, nullable=False),
    Column("subject", String, nullable=False),
    Column("previous", String, nullable=False),
    Column("sha256", String, nullable=False, unique=True),
    Column("text", Text, nullable=False),
    Index("entry_subject", "subject", "seq"),
)


def _indexed(name: str, *columns: Column[Any], by: tuple[str, ...]) -> Table:
    return Table(
        name,
        METADATA,
        Column("seq", Integer, primary_key=True, autoincrement=False),
        Column("line", Integer, primary_key=True, autoincrement=False),
        *columns,
        *(Index(f"{name}_{'_'.join(keys.split())}", *keys.split()) for keys in by),
    )


def _text(name: str, null: bool = True) -> Column[Any]:
    return Column(name, Text(), nullable=null)


def _number(name: str, null: bool = True) -> Column[Any]:
    return Column(name, Double(), nullable=null)


FILE = _indexed("file", _text("sha256", False), _text("name"), _text("format"), _text("role", False), by=("sha256",))
EQUIPMENT = _indexed(
    "equipment",
    *(_text(name, False) for name in ("name", "kind", "state")),
    *(_text(name) for name in ("part_of", "maker", "model", "serial", "firmware", "owner", "location", "remark")),
    by=("name seq", "kind"),
)
CERTIFIED = _indexed(
    "certified",
    *(_text(name, False) for name in ("artefact", "quantity", "unit")),
    _number("value", False),
    _number("u", False),
    _number("temperature_c"),
    _number("expansion_per_k"),
    _number("expansion_u_per_k"),
    *(_text(name) for name in ("number", "by", "sha256", "valid_from", "valid_to")),
    by=("artefact quantity seq",),
)
EVENT = _indexed("event", *(_text(name, False) for name in ("equipment", "kind", "at", "text")), by=("equipment at",))
PERSON = _indexed("person", _text("name", False), _text("roles", False), by=("name seq",))
SETTING = _indexed("setting", _text("name", False), _text("value", False), by=("name seq",))
CALIBRATION = _indexed(
    "calibration",
    *(_text(name, False) for name in ("arm", "sha256", "at", "termination")),
    Column("converged", Boolean, nullable=False),
    _number("cost"),
    _number("degrees_of_freedom"),
    _text("version"),
    by=("arm at", "sha256"),
)
PARAMETER = _indexed(
    "parameter",
    *(_text(name, False) for name in ("arm", "sha256", "at", "name", "unit", "status")),
    _number("value", False),
    _number("u"),
    by=("arm name at", "sha256"),
)
FIGURE = _indexed(
    "figure",
    *(_text(name, False) for name in ("arm", "sha256", "source", "at", "state", "name", "unit")),
    _text("artefact"),
    _number("value", False),
    _number("u"),
    _number("k"),
    _number("limit_value"),
    _text("verdict"),
    by=("arm name at", "sha256"),
)
USED = _indexed("used", *(_text(name, False) for name in ("sha256", "arm", "artefact", "at")), by=("artefact at",))
CERTIFICATE = _indexed(
    "certificate",
    *(_text(name, False) for name in ("number", "arm", "sha256", "issued_at", "issued_by", "head")),
    *(_text(name) for name in ("approved_by", "supersedes", "of")),
    by=("number", "arm issued_at"),
)
STANDING = _indexed("standing", *(_text(name, False) for name in ("subject", "state", "reason")), by=("subject seq",))
INTERVAL = _indexed(
    "interval",
    _text("equipment", False),
    _number("days", False),
    _text("method", False),
    _text("from_at", False),
    _text("due_at", False),
    _text("why"),
    by=("equipment seq", "due_at"),
)
INDEX = tuple(table for table in METADATA.sorted_tables if table is not ENTRY)
"""All that follows from the chain and the files."""
