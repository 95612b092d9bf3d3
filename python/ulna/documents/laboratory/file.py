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

from ulna.documents.laboratory.capability import unknown_figures
from ulna.documents.laboratory.tables import (
    CertificateTable,
    HumidityCondition,
    LaboratoryFile,
    PersonTable,
    TemperatureCondition,
)
from ulna.formats.models import fill_or_list, listed
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
    """Read a laboratory file. Raises UlnaInputError with all that is wrong with it: who fills it in corrects it once.

    What keys say together (days in order, one signer, texts in all languages) is asked where each of them can be read.
    """
    path = Path(path)
    document, sha256 = read_toml(path, WHAT)
    check_format(document, path, "ulna-lab")
    file, problems = fill_or_list(LaboratoryFile, document)
    if file is None:
        raise listed(path, problems)
    laboratory = Laboratory(path, sha256, file)
    problems += [*_languages(file), *_days(file.certificate), *_signer(file.person)]
    problems += _condition(file.environment.temperature, "temperature")
    if file.environment.humidity is not None:
        problems += _condition(file.environment.humidity, "humidity")
    if file.cmc is not None:
        problems += unknown_figures(file.cmc)
    if laboratory.logo is not None and not laboratory.logo.is_file():
        problems.append(
            f"key 'laboratory.logo': {laboratory.logo} is not there; expected a picture. Correct or remove it."
        )
    if problems:
        raise listed(path, problems)
    return laboratory


def _languages(file: LaboratoryFile) -> Iterator[str]:
    known = file.languages
    if len(set(known)) != len(known):
        yield ("key 'languages': a language stands twice; expected each once. Remove one.")
    for key, text in _tables_of_texts(file, ""):
        if set(text) != set(known):
            yield (
                f"key '{key}': has the languages {', '.join(text)}, expected {', '.join(known)}, as the key "
                "'languages' says. Add or remove languages."
            )


def _tables_of_texts(value: object, key: str) -> Iterator[tuple[str, dict[str, str]]]:
    if isinstance(value, BaseModel):
        for name in type(value).model_fields:
            yield from _tables_of_texts(getattr(value, name), f"{key}.{name}" if key else name)
    elif isinstance(value, list):
        for number, each in enumerate(value, start=1):
            yield from _tables_of_texts(each, f"{key}.{number}")
    elif isinstance(value, dict) and all(isinstance(each, str) for each in value.values()):
        yield key, value


def _days(certificate: CertificateTable) -> Iterator[str]:
    days = [
        ("received", certificate.received),
        ("begin", certificate.begin),
        ("end", certificate.end),
        ("issued", certificate.issued),
    ]
    there = [(key, day) for key, day in days if day is not None]
    for (earlier, first), (later, second) in pairwise(there):
        if second < first:
            yield (
                f"key 'certificate.{later}': got {second}, before '{earlier}' ({first}); expected the days in "
                "order: received, begin, end, issued. Correct one of them."
            )


def _signer(persons: list[PersonTable]) -> Iterator[str]:
    count = sum(person.main_signer for person in persons)
    if count != 1:
        yield (f"key 'person': {count} persons have main_signer = true, expected exactly one. Correct it.")


def _condition(condition: TemperatureCondition | HumidityCondition, name: str) -> Iterator[str]:
    """Either value and u, or low and high."""
    given = {key for key in ("value", "u", "low", "high") if getattr(condition, key) is not None}
    if given not in ({"value", "u"}, {"low", "high"}):
        yield (
            f"key 'environment.{name}': has {', '.join(sorted(given)) or 'no number'}, expected value and u "
            "(its standard uncertainty), or low and high. Correct it."
        )
    if condition.low is not None and condition.high is not None and condition.high < condition.low:
        yield (
            f"key 'environment.{name}': low is {condition.low:g} and high {condition.high:g}; expected low "
            "not above high. Exchange them."
        )
