"""What a source of documents owes: how it is read, whether it is of this arm, and its name with its SHA-256."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import BaseModel

from ulna.calibration.result import Result
from ulna.documents.languages.said import Said
from ulna.formats.models import fill_json
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError

T = TypeVar("T")
Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True)
class ReadFile:
    """A file that the document was made with, besides those that the result was made from."""

    path: Path
    sha256: str

    @property
    def name(self) -> str:
        """Without its folder."""
        return self.path.name


@dataclass(frozen=True)
class Calibration:
    """The result that a document is about, as it was read; every source must be of it."""

    result: Result
    file: ReadFile
    """The result.json."""


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


def json_of(format_name: str, what: str, model: type[Model]) -> Callable[[Path, Calibration], tuple[Model, str]]:
    """How a JSON file of Ulna's is read, through its model; what: how messages call it, "an evaluation.json"."""

    def read(path: Path, _: Calibration) -> tuple[Model, str]:
        document, digest = read_json(path, what)
        check_format(document, path, format_name)
        try:
            return fill_json(model, document, path), digest
        except UlnaInputError as error:
            said = str(error).removesuffix(" Add it.")  # nobody writes such a file by hand
            raise UlnaInputError(f"{said} The file was changed or damaged: make it again.") from None

    return read


@dataclass(frozen=True)
class Taken(Generic[T]):
    """A source that was read and is of this arm, as far as can be told."""

    value: T
    file: ReadFile
    remarks: list[Said]


def take(source: Source[T], path: Path, calibration: Calibration) -> Taken[T]:
    """Read and checked. Raises UlnaInputError."""
    value, digest = source.read(path, calibration)
    return Taken(value, ReadFile(path, digest), source.remarks(value, path, calibration))
