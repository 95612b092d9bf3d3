"""What the record has of one kind: certified values of an artefact, certificates that were issued."""

from __future__ import annotations

from sqlalchemy import Connection, select

from ulna.records import asked
from ulna.records.tables import CERTIFICATE, CERTIFIED


def values(connection: Connection, artefact: str) -> list[asked.Row]:
    """All that its certificates ever said, the newest first. Raises UlnaInputError where it is not registered."""
    name = asked.equipment(connection, artefact)["name"]
    asked_for = select(CERTIFIED).where(CERTIFIED.c.artefact == name)
    return asked.rows(connection, asked_for.order_by(CERTIFIED.c.seq.desc(), CERTIFIED.c.line))


def certificates(connection: Connection, arm: str | None) -> list[asked.Row]:
    """Issued, the newest first, each with its "state" and the "reason" of it. Raises UlnaInputError for an arm that is
    not registered."""
    asked_for = select(CERTIFICATE).order_by(CERTIFICATE.c.seq.desc())
    if arm is not None:
        asked_for = asked_for.where(CERTIFICATE.c.arm == asked.equipment(connection, arm)["name"])
    found: list[asked.Row] = []
    for row in asked.rows(connection, asked_for):
        standing = asked.standing(connection, str(row["number"])) or {"state": "in force", "reason": ""}
        found.append({**row, "state": standing["state"], "reason": standing["reason"]})
    return found
