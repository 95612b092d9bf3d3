"""What no longer counts, and why: it is kept all the same."""

from __future__ import annotations

from sqlalchemy import Connection, select

from ulna.ground.errors import UlnaInputError
from ulna.records import asked
from ulna.records.acts.filed import MAIN
from ulna.records.acts.standing import WITHDRAWN
from ulna.records.bench import Bench, checked_text
from ulna.records.entry import Entry
from ulna.records.tables import CERTIFICATE, ENTRY, FILE


def withdraw(bench: Bench, subject: str, reason: str) -> Entry:
    """A certificate by its number, or a filed file by its SHA-256 or the beginning of it. Raises UlnaInputError for
    what is not there, is withdrawn already, or has no reason."""
    reason = checked_text(reason, "reason", 2000)
    with bench.writing() as doing:
        found, arm = _found(doing.connection, checked_text(subject, "what is withdrawn"))
        now = asked.standing(doing.connection, found)
        if now is not None and now["state"] == WITHDRAWN:
            raise UlnaInputError(f"record: '{subject}' is withdrawn already: {now['reason']}")
        return doing.add("standing", found, {"state": WITHDRAWN, "reason": reason, "arm": arm})


def _found(connection: Connection, subject: str) -> tuple[str, str]:
    number = connection.execute(
        select(CERTIFICATE.c.number, CERTIFICATE.c.arm).where(CERTIFICATE.c.number == subject)
    ).first()
    if number is not None:
        return str(number[0]), str(number[1])
    sha256, arm = filed(connection, subject)
    return sha256, arm


def filed(connection: Connection, sha256: str) -> tuple[str, str]:
    """(SHA-256, arm) of a filed file, by its SHA-256 or eight or more letters that it begins with. Raises
    UlnaInputError."""
    begins = sha256.lower()
    found = set()
    if len(begins) >= 8 and all(each in "0123456789abcdef" for each in begins):
        rows = connection.execute(
            select(FILE.c.sha256, ENTRY.c.subject)
            .join(ENTRY, ENTRY.c.seq == FILE.c.seq)
            .where(FILE.c.sha256.startswith(begins), FILE.c.role == MAIN, ENTRY.c.act == "filed")
        )
        found = {(str(one), str(arm)) for one, arm in rows}
    if len(found) != 1:
        what = "no file or certificate" if not found else f"{len(found)} files"
        raise UlnaInputError(
            f"record: {what} '{sha256[:70]}'; expected the number of a certificate, or eight or more of the letters "
            "that one file's SHA-256 begins with. See ulna record history."
        )
    return next(iter(found))
