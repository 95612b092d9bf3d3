"""A certificate that leaves the house: numbered, by one or by four eyes, with the head of the record on it."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from sqlalchemy import Connection, select

from ulna.documents.certificate import certificate
from ulna.documents.laboratory.issued import Issued
from ulna.ground.errors import UlnaInputError
from ulna.records import asked, chain
from ulna.records.acts.setting import NAMES
from ulna.records.bench import Bench, Writing, checked_text
from ulna.records.filing import ARMS
from ulna.records.history import calibrations
from ulna.records.registering import content_of, file_name, may
from ulna.records.standing import filed
from ulna.records.tables import CERTIFICATE, ENTRY, EQUIPMENT, FILE, STANDING


@dataclass(frozen=True)
class Asked:
    """What is to be issued."""

    result: str
    """A filed calibration, by its SHA-256 or the beginning of it; or an arm, whose last one is meant."""
    laboratory: Path
    verification: Sequence[str] = ()
    """Filed tests, in the same way."""
    number: str | None = None
    """None: the next by the record's pattern."""
    form: str = "pdf"
    language: str = "en"
    approved_by: str | None = None
    supersedes: str | None = None
    reason: str | None = None
    """Why the earlier one is superseded."""


@dataclass(frozen=True)
class IssuedCertificate:
    """What became of it."""

    number: str
    arm: str
    sha256: str
    head: str
    """Of the record when it was issued, as it stands on the certificate."""
    content: bytes


@dataclass(frozen=True)
class _Planned:
    """What the record says of it at one moment."""

    result: str
    """SHA-256 of the calibration."""
    arm: str
    tests: list[str]
    number: str
    head: str


def issue(bench: Bench, wanted: Asked) -> IssuedCertificate:
    """Made, kept and entered, or nothing of it. Raises UlnaInputError for a calibration that was withdrawn or is not
    filed, for a number that was given, and where a second person is needed.

    It takes seconds to be made, in which others may write: where they did, its head, and perhaps its number, is another
    one, and it is made anew; after some times while nobody else can write.
    """
    laboratory = content_of(wanted.laboratory)
    for _ in range(_TIMES):
        now = datetime.fromisoformat(chain.now())
        with bench.reading() as connection:
            planned = _planned(connection, bench.by, wanted, now)
        content = _made(bench, wanted, planned, now)
        with bench.writing() as doing:
            if _planned(doing.connection, bench.by, wanted, now) == planned:
                return _entered(doing, wanted, planned, now, content, laboratory)
    with bench.writing() as doing:
        now = datetime.fromisoformat(chain.now())
        planned = _planned(doing.connection, bench.by, wanted, now)
        content = _made(bench, wanted, planned, now)
        return _entered(doing, wanted, planned, now, content, laboratory)


def _planned(connection: Connection, by: str, wanted: Asked, now: datetime) -> _Planned:
    """Raises UlnaInputError for what cannot be issued."""
    sha256, arm = _stands(connection, _last(connection, wanted.result) or wanted.result)
    tests = [_of(connection, each, arm) for each in wanted.verification]
    _eyes(connection, by, wanted.approved_by, [sha256, *tests])
    _superseded(connection, wanted)
    number = checked_text(wanted.number, "number") if wanted.number else _next(connection, now.year)
    if connection.scalar(select(CERTIFICATE.c.seq).where(CERTIFICATE.c.number == number)) is not None:
        raise UlnaInputError(f"record: certificate {number} was issued already; expected a new number. Choose another.")
    return _Planned(sha256, arm, tests, number, chain.head(connection)[1])


def _entered(
    doing: Writing, wanted: Asked, planned: _Planned, now: datetime, content: bytes, laboratory: bytes
) -> IssuedCertificate:
    """Raises UlnaInputError where the laboratory file is another one by now."""
    if content_of(wanted.laboratory) != laboratory:
        raise UlnaInputError(f"{wanted.laboratory}: was changed while it was read. Try again.")
    number, files = planned.number, doing.bench.files
    kept = files.put(content)
    stated = {
        "arm": planned.arm,
        "issued_at": now.isoformat(),
        "names": {"certificate": f"{number}.{_ENDINGS[wanted.form]}", "laboratory": file_name(wanted.laboratory)},
        "approved_by": wanted.approved_by,
        "supersedes": wanted.supersedes,
        "reason": wanted.reason,
    }
    named = {"certificate": kept, "laboratory": files.put(laboratory), "result": planned.result}
    named |= {f"verification {k}": each for k, each in enumerate(planned.tests, start=1)}
    doing.add("issued", number, {key: value for key, value in stated.items() if value is not None}, named)
    return IssuedCertificate(number, planned.arm, kept, planned.head, content)


_TIMES = 3
"""That a certificate is made before others have to wait for it."""
_ENDINGS = {"pdf": "pdf", "dcc": "xml"}


def _made(bench: Bench, wanted: Asked, planned: _Planned, now: datetime) -> bytes:
    """Of the files as they are in the store, under names that the readers expect."""
    said = Issued(planned.number, now, bench.by, wanted.approved_by, wanted.supersedes, planned.head)
    named = {"result.json": planned.result}
    named |= {f"verification-{k}.json": each for k, each in enumerate(planned.tests)}
    with tempfile.TemporaryDirectory(prefix="ulna-") as folder:
        place = Path(folder)
        paths = []
        for name, sha256 in named.items():
            (place / name).write_bytes(bench.files.get(sha256))
            paths.append(place / name)
        first, *others = paths
        return certificate(
            first,
            wanted.laboratory,
            verification=others,
            form=wanted.form,
            issued=said,
            language=wanted.language,
            look=False,
        )


def _last(connection: Connection, name: str) -> str | None:
    """The last calibration of an arm; None of what is no arm. Raises UlnaInputError where it has none."""
    row = asked.last_of(connection, EQUIPMENT, "name", name)
    if row is None or row["kind"] not in ARMS:
        return None
    made = calibrations(connection, name)
    if not made:
        raise UlnaInputError(f"record: '{name}' has no calibration; expected one. File it: ulna record add FILE.")
    return str(made[-1]["sha256"])


def _of(connection: Connection, begins: str, arm: str) -> str:
    sha256, whose = _stands(connection, begins)
    if whose != arm:
        raise UlnaInputError(
            f"record: {begins} is of '{whose}', the calibration of '{arm}'; expected one arm. Name another."
        )
    return sha256


def _stands(connection: Connection, begins: str) -> tuple[str, str]:
    sha256, arm = filed(connection, begins)
    row = asked.standing(connection, sha256)
    if row is not None and row["state"] != "in force":
        raise UlnaInputError(f"record: {begins} was {row['state']}: {row['reason']}. Issue of another.")
    state = asked.equipment(connection, arm)["state"]
    if state == "quarantined":
        raise UlnaInputError(
            f"record: '{arm}' is quarantined; expected it in use. Release it: ulna record event {arm!r} release TEXT."
        )
    return sha256, arm


def _eyes(connection: Connection, by: str, approved_by: str | None, files: Sequence[str]) -> None:
    """Whoever approves neither issues it nor filed what it says (ISO/IEC 17025, 4.1: nobody judges their own work)."""
    if asked.setting(connection, "four-eyes", NAMES["four-eyes"]) != "yes":
        return
    if approved_by is None or approved_by == by:
        raise UlnaInputError(
            f"record: certificates need four eyes here, and {by} issues; expected another person. Give "
            "--approved-by NAME."
        )
    if not may(connection, approved_by, "reviewer"):
        raise UlnaInputError(
            f"record: '{approved_by}' is no reviewer; expected one. Register: ulna record person NAME --role reviewer."
        )
    of_files = select(ENTRY.c.actor).join(FILE, FILE.c.seq == ENTRY.c.seq)
    if approved_by in connection.scalars(of_files.where(FILE.c.sha256.in_(files), ENTRY.c.act == "filed")).all():
        raise UlnaInputError(
            f"record: '{approved_by}' filed what is to be certified; expected somebody who did not. Give "
            "--approved-by NAME."
        )


def _superseded(connection: Connection, wanted: Asked) -> None:
    if wanted.supersedes is None:
        return
    if not wanted.reason:
        raise UlnaInputError(f"record: why {wanted.supersedes} is superseded is not said. Give --reason TEXT.")
    row = asked.last_of(connection, STANDING, "subject", wanted.supersedes)
    if row is None or row["state"] != "in force":
        state = "was never issued" if row is None else f"is {row['state']}: {row['reason']}"
        raise UlnaInputError(f"record: certificate {wanted.supersedes} {state}; expected one in force. Name another.")


def _next(connection: Connection, year: int) -> str:
    """The first number by the pattern that was not given yet."""
    pattern = asked.setting(connection, "numbers", NAMES["numbers"])
    given = set(connection.scalars(select(CERTIFICATE.c.number)))
    return next(number for n in range(1, len(given) + 2) if (number := pattern.format(year=year, n=n)) not in given)
