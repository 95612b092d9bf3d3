"""A certificate of files of the desk, issued by the record."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from ulna.records.records import Records
from ulna.serve.beside import together
from ulna.serve.contract.filing import IssueAsked, IssuedNow
from ulna.serve.desk import Desk

ENDINGS = {"pdf": "pdf", "dcc": "xml"}
"""Of files, by the form of a certificate."""


def issued(desk: Desk, records: Records, asked: IssueAsked) -> IssuedNow:
    """Entered, and on the desk; or nothing of it. records: with whoever issues at work. Raises UlnaInputError."""
    with TemporaryDirectory(prefix="ulna-") as folder:
        found = records.issue(
            asked.result,
            together(desk, Path(folder), asked.laboratory, asked.beside),
            verification=asked.verification,
            number=asked.number,
            form=asked.form,
            language=asked.language,
            approved_by=asked.approved_by,
            supersedes=asked.supersedes,
            reason=asked.reason,
        )
    info = desk.put(f"{found.number}.{ENDINGS[asked.form]}", found.content)
    return IssuedNow(number=found.number, arm=found.arm, sha256=info.sha256, name=info.name, head=found.head)
