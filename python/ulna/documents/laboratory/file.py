"""Laboratory files: `ulna-lab/1`, TOML: what a certificate says beyond the numbers, and only the laboratory knows.

The XML certificate and the printed one are made from the same file. What may be left out is optional here, and a
certificate says so where it is missing; nothing is filled in for the laboratory.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from pydantic import BaseModel

from ulna.documents.laboratory.tables import (
    CertificateTable,
    HumidityCondition,
    LaboratoryFile,
    PersonTable,
    TemperatureCondition,
)
from ulna.formats.models import fill
from ulna.formats.toml import check_format, read_toml
from ulna.ground.errors import UlnaInputError

WHAT = 'a laboratory file (TOML, format = "ulna-lab/1")'


@dataclass(frozen=True)
class Laboratory:
    """A laboratory file that was read and checked."""

    path: Path
    sha256: str
    file: LaboratoryFile

    @property
    def main_signer(self) -> PersonTable:
        """Who signs first."""
        return next(person for person in self.file.person if person.main_signer)

    @property
    def logo(self) -> Path | None:
        """The picture for the letterhead, where one is named."""
        named = self.file.laboratory.logo
        return None if named is None else self.path.parent / named

    def spoken(self, text: str | dict[str, str], language: str) -> str:
        """A text in one language; a text that names no language is the same in all. Raises UlnaInputError."""
        if isinstance(text, str):
            return text
        if language not in text:
            raise UlnaInputError(
                f"{self.path}: key 'languages': the texts are in {', '.join(self.file.languages)}, but a certificate "
                f"in '{language}' was asked for. Add that language to the file, or ask for one of these."
            )
        return text[language]


def load_laboratory(path: str | Path) -> Laboratory:
    """Read a laboratory file. Raises UlnaInputError."""
    path = Path(path)
    document, sha256 = read_toml(path, WHAT)
    check_format(document, path, "ulna-lab")
    file = fill(LaboratoryFile, document, path)
    laboratory = Laboratory(path, sha256, file)
    _check_languages(file, path)
    _check_days(file.certificate, path)
    _check_signer(file.person, path)
    _check_condition(file.environment.temperature, path, "temperature")
    if file.environment.humidity is not None:
        _check_condition(file.environment.humidity, path, "humidity")
    if laboratory.logo is not None and not laboratory.logo.is_file():
        raise UlnaInputError(
            f"{path}: key 'laboratory.logo': {laboratory.logo} is not there; expected a picture. Correct or remove it."
        )
    return laboratory


def _check_languages(file: LaboratoryFile, path: Path) -> None:
    known = file.languages
    if len(set(known)) != len(known):
        raise UlnaInputError(f"{path}: key 'languages': a language stands twice; expected each once. Remove one.")
    for key, text in _tables_of_texts(file, ""):
        if set(text) != set(known):
            raise UlnaInputError(
                f"{path}: key '{key}': has the languages {', '.join(text)}, expected {', '.join(known)}, as the key "
                "'languages' says. Add or remove languages."
            )


def _tables_of_texts(value: object, key: str) -> Iterator[tuple[str, dict[str, str]]]:
    if isinstance(value, BaseModel):
        for name in type(value).model_fields:
            yield from _tables_of_texts(getattr(value, name), f"{key}.{name}" if key else name)
    elif isinstance(value, list):
        for number, each in enumerate(value, start=1):
            yield from _tables_of_texts(each, f"{key}.{number}")
    elif isinstance(value, dict):
        yield key, value


def _check_days(certificate: CertificateTable, path: Path) -> None:
    days = [
        ("received", certificate.received),
        ("begin", certificate.begin),
        ("end", certificate.end),
        ("issued", certificate.issued),
    ]
    there = [(key, day) for key, day in days if day is not None]
    for (earlier, first), (later, second) in pairwise(there):
        if second < first:
            raise UlnaInputError(
                f"{path}: key 'certificate.{later}': got {second}, before '{earlier}' ({first}); expected the days in "
                "order: received, begin, end, issued. Correct one of them."
            )


def _check_signer(persons: list[PersonTable], path: Path) -> None:
    count = sum(person.main_signer for person in persons)
    if count != 1:
        raise UlnaInputError(
            f"{path}: key 'person': {count} persons have main_signer = true, expected exactly one. Correct it."
        )


def _check_condition(condition: TemperatureCondition | HumidityCondition, path: Path, name: str) -> None:
    """Either value and u, or low and high."""
    given = {key for key in ("value", "u", "low", "high") if getattr(condition, key) is not None}
    if given not in ({"value", "u"}, {"low", "high"}):
        raise UlnaInputError(
            f"{path}: key 'environment.{name}': has {', '.join(sorted(given)) or 'no number'}, expected value and u "
            "(its standard uncertainty), or low and high. Correct it."
        )
    if condition.low is not None and condition.high is not None and condition.high < condition.low:
        raise UlnaInputError(
            f"{path}: key 'environment.{name}': low is {condition.low:g} and high {condition.high:g}; expected low "
            "not above high. Exchange them."
        )
