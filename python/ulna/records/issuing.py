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
from ulna.records.bench import Bench, checked_text
from ulna.records.filing import ARMS
from ulna.records.history import calibrations
from ulna.records.registering import content_of, file_name, keep, may
from ulna.records.standing import filed
from ulna.records.store import sha256_of
from ulna.records.tables import CERTIFICATE, EQUIPMENT, STANDING


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


def issue(bench: Bench, wanted: Asked) -> IssuedCertificate:
    """Made, kept and entered, or nothing of it. Raises UlnaInputError for a calibration that was withdrawn or is not
    filed, for a number that was given, and where a second person is needed."""
    with bench.writing() as doing:
        connection = doing.connection
        sha256, arm = _stands(connection, _last(connection, wanted.result) or wanted.result)
        tests = [_of(connection, each, arm) for each in wanted.verification]
        _eyes(connection, bench.by, wanted.approved_by)
        _superseded(connection, wanted)
        now = datetime.fromisoformat(chain.now())
        number = checked_text(wanted.number, "number") if wanted.number else _next(connection, now.year)
        if connection.scalar(select(CERTIFICATE.c.seq).where(CERTIFICATE.c.number == number)) is not None:
            raise UlnaInputError(
                f"record: certificate {number} was issued already; expected a new number. Choose another."
            )
        _, head = chain.head(connection)
        laboratory = keep(bench, wanted.laboratory)
        said = Issued(number, now, bench.by, wanted.approved_by, wanted.supersedes, head)
        content = _made(bench, wanted, sha256, tests, said)
        if sha256_of(content_of(wanted.laboratory)) != laboratory:
            raise UlnaInputError(f"{wanted.laboratory}: was changed while it was read. Try again.")
        kept = bench.files.put(content)
        stated = {
            "arm": arm,
            "issued_at": now.isoformat(),
            "names": {"certificate": f"{number}.{_ENDINGS[wanted.form]}", "laboratory": file_name(wanted.laboratory)},
            "approved_by": wanted.approved_by,
            "supersedes": wanted.supersedes,
            "reason": wanted.reason,
        }
        files = {"certificate": kept, "laboratory": str(laboratory), "result": sha256}
        files |= {f"verification {k}": each for k, each in enumerate(tests, start=1)}
        doing.add("issued", number, {key: value for key, value in stated.items() if value is not None}, files)
    return IssuedCertificate(number, arm, kept, head, content)


_ENDINGS = {"pdf": "pdf", "dcc": "xml"}


def _made(bench: Bench, wanted: Asked, result: str, tests: Sequence[str], said: Issued) -> bytes:
    """Of the files as they are in the store, under names that the readers expect."""
    with tempfile.TemporaryDirectory(prefix="ulna-") as folder:
        place = Path(folder)
        paths = []
        for name, sha256 in (("result.json", result), *((f"verification-{k}.json", t) for k, t in enumerate(tests))):
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


def _eyes(connection: Connection, by: str, approved_by: str | None) -> None:
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
