"""Files of the desk: what was brought here, by the hash of what is in it."""

from __future__ import annotations

from enum import StrEnum

from ulna.serve.contract.model import Name, Said, Sentence, Sha256


class FileKind(StrEnum):
    """What a file is, as far as Ulna knows it."""

    ARM = "arm"
    RESULT = "result"
    PLAN = "plan"
    PLANNED = "planned"
    STUDY = "study"
    SOURCE = "source"
    PROTOCOL = "protocol"
    CHECK = "check"
    PROFILE = "profile"
    TEST = "test"
    VERIFICATION = "verification"
    LABORATORY = "laboratory"
    TABLE = "table"
    OTHER = "other"


class FileInfo(Said):
    """One file."""

    sha256: Sha256
    name: Name
    size: int
    kind: FileKind
    what: Sentence
    """In a few words: "arm 'Platinum', 7 joints"; or why it cannot be used."""
    at: str
    """When it came, UTC."""


class Files(Said):
    """All of them, the newest first."""

    files: list[FileInfo]
