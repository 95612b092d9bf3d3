"""What a source of documents owes: how it is read, whether it is of this arm, and its name with its SHA-256."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from ulna.calibration.result import Result
from ulna.documents.languages.said import Said

T = TypeVar("T")


@dataclass(frozen=True)
class Calibration:
    """The result that a document is about, as it was read; every source must be of it."""

    result: Result
    path: Path
    """Of the result.json."""
    sha256: str


@dataclass(frozen=True)
class ReadFile:
    """A file that the document was made with, besides those of the result."""

    name: str
    sha256: str


@dataclass(frozen=True)
class Source(Generic[T]):
    """A kind of file that a document may be made with."""

    name: str
    """As `gather` and the command call it, with hyphens: "cross-validation"."""
    format: str
    """What its key `format` begins with: "ulna-cross-validation"."""
    read: Callable[[Path, Calibration], tuple[T, str]]
    """The content and the SHA-256 of the file. Raises UlnaInputError for one that cannot be used."""
    remarks: Callable[[T, Path, Calibration], list[Said]]
    """What must be said where it is of another arm, or does not tell. Raises UlnaInputError where it must not be
    used at all."""


@dataclass(frozen=True)
class Taken(Generic[T]):
    """A source that was read and is of this arm, as far as can be told."""

    value: T
    path: Path
    file: ReadFile
    remarks: list[Said]


def take(source: Source[T], path: Path, calibration: Calibration) -> Taken[T]:
    """Read and checked. Raises UlnaInputError."""
    value, digest = source.read(path, calibration)
    return Taken(value, path, ReadFile(path.name, digest), source.remarks(value, path, calibration))
