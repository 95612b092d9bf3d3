"""That a certificate was issued: its number, by whom and when, what it supersedes, where it stands in a record.

Ulna signs nothing: who keeps records of certificates says so here, and answers for it.
"""

from __future__ import annotations

import datetime
import re
from dataclasses import dataclass, replace

from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import ReplacedTable
from ulna.documents.laboratory.texts import unwritable
from ulna.ground.errors import UlnaInputError

_HEAD = re.compile("[0-9a-f]{64}")


@dataclass(frozen=True)
class Issued:
    """What makes a draft a certificate. Raises UlnaInputError for a field that cannot stand on one."""

    number: str
    """Of the certificate, unique; it takes the place of the laboratory file's `certificate.identifier`."""
    issued_at: datetime.date
    """Day of issue, or the time of it, of which the day is printed; it takes the place of `certificate.issued`."""
    issued_by: str
    """Who issued it."""
    approved_by: str | None = None
    """Who authorised it (ISO/IEC 17025:2017, 7.8.2.1 o), where that is somebody else."""
    supersedes: str | None = None
    """Number of the certificate that this one takes the place of (7.8.8)."""
    audit_head: str | None = None
    """SHA-256 of the record up to this certificate, 64 hexadecimal digits in small letters."""

    def __post_init__(self) -> None:
        for key in ("number", "issued_by", "approved_by", "supersedes"):
            _check(key, getattr(self, key))
        if not isinstance(self.issued_at, datetime.date):
            raise UlnaInputError(
                f"issued: issued_at is {self.issued_at!r}; expected a datetime.date, or a datetime.datetime. Give one."
            )
        if self.audit_head is not None and _HEAD.fullmatch(self.audit_head) is None:
            raise UlnaInputError(
                f"issued: audit_head is {self.audit_head[:80]!r}; expected 64 hexadecimal digits in small letters, a "
                "SHA-256. Correct it."
            )
        if self.supersedes == self.number:
            raise UlnaInputError(
                f"issued: certificate {self.number} would supersede itself; expected the number of an earlier one. "
                "Correct it."
            )

    @property
    def day(self) -> datetime.date:
        """Of issue."""
        at = self.issued_at
        return at.date() if isinstance(at, datetime.datetime) else at

    @property
    def authorised_by(self) -> str:
        """Who answers for it."""
        return self.issued_by if self.approved_by is None else self.approved_by

    def on(self, laboratory: Laboratory) -> Laboratory:
        """The laboratory file with this number, day and superseded certificate. Raises UlnaInputError where it says
        otherwise: the day is before the calibration's last, or another certificate is replaced."""
        made = laboratory.file.certificate
        if self.day < made.end:
            raise UlnaInputError(
                f"{laboratory.path}: key 'certificate.end': the calibration ended on {made.end}, but the certificate "
                f"{self.number} was issued on {self.day}; expected the same day or a later one. Correct one of them."
            )
        if made.replaces is not None and self.supersedes not in (None, made.replaces.identifier):
            raise UlnaInputError(
                f"{laboratory.path}: key 'certificate.replaces': names {made.replaces.identifier}, but certificate "
                f"{self.number} supersedes {self.supersedes}; expected the same one. Remove the key, or correct it."
            )
        replaces = made.replaces
        if replaces is None and self.supersedes is not None:
            replaces = ReplacedTable(identifier=self.supersedes, change="substituted")
        stated = {"identifier": self.number, "issued": self.day, "replaces": replaces}
        file = laboratory.file.model_copy(update={"certificate": made.model_copy(update=stated)})
        return replace(laboratory, file=file)


def _check(key: str, text: str | None) -> None:
    """One line that a certificate can hold."""
    if text is None:
        return
    if not text.strip() or "\n" in text or unwritable(text) is not None:
        raise UlnaInputError(f"issued: {key} is {str(text)[:80]!r}; expected a text of one line. Correct it.")
