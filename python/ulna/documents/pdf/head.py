"""What stands about the text of each page: who issues it, its number and date, the letterhead, who signs."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any

from ulna.documents.content.content import Content
from ulna.documents.languages.text import joined
from ulna.documents.languages.words import Words
from ulna.documents.pdf.picture_size import MOST_PIXELS, pixels
from ulna.documents.pdf.svg_size import too_large
from ulna.documents.pdf.text import clean, line, name
from ulna.documents.sections.laboratory import accreditation, contact
from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError

#: characters of the laboratory's name in the head of later pages; the first page has all of it
LONGEST_ISSUER = 60
_MOST_BYTES = 16 << 20
_PICTURES = {b"\x89PNG": "png", b"\xff\xd8\xff": "jpg", b"GIF8": "gif", b"RIFF": "webp"}


def identifier(content: Content) -> str:
    """The certificate's number, or that of the result where there is no certificate: the begin of its SHA-256."""
    if content.laboratory is None:
        return f"{name(content.provenance.result)} · SHA-256 {content.provenance.result_sha256[:16]}…"
    return name(content.laboratory.file.certificate.identifier)


def date(content: Content) -> tuple[int, int, int] | None:
    """Of issue, else of the calibration's end, else of the result; None where none of them is known."""
    if content.laboratory is not None:
        made = content.laboratory.file.certificate
        day = made.issued or made.end
        return day.year, day.month, day.day
    try:
        when = datetime.datetime.fromisoformat(content.provenance.time)
    except ValueError:
        return None
    return when.year, when.month, when.day


def issuer(content: Content, words: Words) -> str:
    """Who is named at the top of each page."""
    if content.laboratory is None:
        return ""
    found = content.laboratory
    return name(found.spoken(found.file.laboratory.name, words.language))


def running_issuer(content: Content, words: Words) -> str:
    """The same for the head of the second and later pages, where it has two lines: cut where it is longer."""
    if content.laboratory is None:
        return ""
    found = content.laboratory
    given = found.spoken(found.file.laboratory.name, words.language)
    return name(given if len(given) <= LONGEST_ISSUER else given[: LONGEST_ISSUER - 1].rstrip() + "…")


def letterhead(content: Content, words: Words) -> list[str]:
    """Lines of the letterhead, the name first."""
    if content.laboratory is None:
        return []
    found = content.laboratory
    lines = contact(found, found.file.laboratory, words)
    accredited = accreditation(found.file.laboratory)
    if accredited:
        lines.append(joined([words("laboratory.accreditation"), accredited], ": "))
    return [line(each, words.language) for each in lines]


def logo(content: Content, words: Words) -> dict[str, Any] | None:
    """The laboratory's picture with its kind. Raises UlnaInputError for a file that is none."""
    if content.laboratory is None or content.laboratory.logo is None:
        return None
    path: Path = content.laboratory.logo
    picture = read_bytes(path, "a logo", _MOST_BYTES + 1)
    size = pixels(picture) or 0
    if len(picture) > _MOST_BYTES or size > MOST_PIXELS:
        got = f"a picture of {size / 1e6:.0f} million points" if size > MOST_PIXELS else "a file of more than 16 MB"
        raise UlnaInputError(
            f"{path}: {got}; expected a logo of {MOST_PIXELS / 1e6:.0f} million points and {_MOST_BYTES >> 20} MB at "
            "most. Save a smaller one."
        )
    kind = next((kind for begin, kind in _PICTURES.items() if picture.startswith(begin)), None)
    if kind is None and b"<svg" in picture[:2000]:
        kind = "svg"
        vast = too_large(picture)
        if vast is not None:
            raise UlnaInputError(f"{path}: {vast}; expected a logo that can be printed. Save a simpler one.")
    if kind is None:
        raise UlnaInputError(
            f"{path}: is no picture that can be printed; expected PNG, JPEG, GIF, WebP or SVG, as the key "
            f"'laboratory.logo' of {content.laboratory.path} names it. Name another file there."
        )
    return {"bytes": list(picture), "format": kind, "alt": issuer(content, words)}


def people(content: Content, words: Words) -> list[list[str]]:
    """Who signs, the main signer first: name and role; an empty line where nobody is named."""
    if content.laboratory is None:
        return [[" ", " "]]
    found = content.laboratory
    persons = sorted(found.file.person, key=lambda each: not each.main_signer)
    return [[name(each.name), clean(found.spoken(each.role, words.language))] for each in persons]
