"""The first page: who calibrated what for whom, when, where, with what, traceable how; and what is not stated."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any

from ulna.documents.content import Content
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import Address, ContactTable, HumidityCondition, TemperatureCondition
from ulna.documents.languages.words import Words
from ulna.documents.pdf import blocks, results
from ulna.documents.pdf.blocks import Block, Cell
from ulna.documents.pdf.text import clean, name
from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError

#: characters of the laboratory's name in the head of later pages; the first page has all of it
LONGEST_ISSUER = 60
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
    lines = _contact(found, found.file.laboratory, words.language)
    given = found.file.laboratory.accreditation
    if given is not None:
        parts = [given.body, given.number, *([given.standard] if given.standard else [])]
        lines.append(f"{words('laboratory.accreditation')}: {', '.join(name(part) for part in parts)}")
    return lines


def logo(content: Content, words: Words) -> dict[str, Any] | None:
    """The laboratory's picture with its kind. Raises UlnaInputError for a file that is none."""
    if content.laboratory is None or content.laboratory.logo is None:
        return None
    path: Path = content.laboratory.logo
    picture = read_bytes(path, "a logo")
    kind = next((kind for begin, kind in _PICTURES.items() if picture.startswith(begin)), None)
    if kind is None and b"<svg" in picture[:2000]:
        kind = "svg"
    if kind is None:
        raise UlnaInputError(
            f"{path}: is no picture that can be printed; expected PNG, JPEG, GIF, WebP or SVG, as the key "
            f"'laboratory.logo' of {content.laboratory.path} names it. Name another file there."
        )
    return {"bytes": list(picture), "format": kind, "alt": issuer(content, words)}


def first_page(content: Content, words: Words) -> list[Block]:
    """All that stands before the results."""
    found = content.laboratory
    page: list[Block] = []
    if not content.fit.converged:
        page.append(blocks.paragraph(results.ending_sentence(content, words), "bad"))
    if found is None:
        page.append(blocks.paragraph(words("paper.no-laboratory"), "bad"))
    page.append(blocks.facts(_facts(content, words)))
    page += _traceability(content, words)
    if found is not None:
        page += _environment(found, words)
        page += [blocks.heading(words("laboratory.remark"))] if found.file.remarks else []
        page += [blocks.paragraph(name(found.spoken(each, words.language))) for each in found.file.remarks]
    return page


def _facts(content: Content, words: Words) -> list[tuple[str, list[Cell]]]:
    found, language = content.laboratory, words.language
    made = content.provenance
    arm: list[Cell] = [words("paper.arm", arm=content.arm, joints=content.joints)]
    if found is None:
        return [
            (words("laboratory.item"), arm),
            (words("paper.calibrated"), [name(made.time)]),
            (words("laboratory.laboratory"), [words("paper.not-stated")]),
            (words("laboratory.customer"), [words("paper.not-stated")]),
        ]
    file = found.file
    item, certificate = file.item, file.certificate
    lines: list[Cell] = [
        name(found.spoken(item.name, language)),
        f"{name(item.manufacturer)} {name(item.model)}",
        f"{words('laboratory.serial')} {name(item.serial)}",
    ]
    if item.description is not None:
        lines.append(name(found.spoken(item.description, language)))
    for each in item.identifications:
        label = "" if each.name is None else f"{name(found.spoken(each.name, language))}: "
        lines.append(f"{label}{name(each.value)}")
    rows: list[tuple[str, list[Cell]]] = [
        (words("laboratory.item"), [*lines, *arm]),
        (words("laboratory.customer"), [*_contact(found, file.customer, language)]),
    ]
    if certificate.order is not None:
        rows.append((words("laboratory.order"), [name(certificate.order)]))
    days = [
        ("received", certificate.received),
        ("begin", certificate.begin),
        ("end", certificate.end),
        ("issued", certificate.issued),
    ]
    rows += [(words(f"laboratory.{key}"), [day.isoformat()]) for key, day in days if day is not None]
    rows.append((words("paper.location"), [words(f"location.{certificate.location}")]))
    if certificate.replaces is not None:
        replaced = certificate.replaces
        rows.append((words(f"replaces.{replaced.change}"), [name(replaced.identifier)]))
    for method in file.method:
        cells: list[Cell] = [name(found.spoken(method.name, language))]
        if method.description is not None:
            cells.append(name(found.spoken(method.description, language)))
        more = [name(each) for each in (*method.norms, *method.references)]
        rows.append((words("laboratory.method"), [*cells, *([", ".join(more)] if more else [])]))
    if not file.method:
        rows.append((words("laboratory.method"), [words("paper.not-stated")]))
    return rows


def _contact(found: Laboratory, contact: ContactTable, language: str) -> list[str]:
    lines = [name(found.spoken(contact.name, language)), *_address(contact.address)]
    return lines + [name(each) for each in (contact.email, contact.phone, contact.web) if each is not None]


def _address(address: Address) -> list[str]:
    place = " ".join(name(each) for each in (address.postcode, address.city) if each is not None)
    country = ", ".join(name(each) for each in (address.state, address.country) if each is not None)
    street = [name(address.street)] if address.street else []
    return [", ".join([*street, place, country])]


def _traceability(content: Content, words: Words) -> list[Block]:
    """The statement and the standards' certificates; where they are missing, that they are."""
    page = [blocks.heading(words("section.traceability"))]
    found = content.laboratory
    if found is None:
        return [*page, blocks.paragraph(words("paper.no-traceability"), "bad")]
    file, language = found.file, words.language
    if file.traceability is None:
        page.append(blocks.paragraph(words("paper.no-traceability"), "bad"))
    else:
        page.append(blocks.paragraph(name(found.spoken(file.traceability.statement, language))))
    if not file.equipment:
        return [*page, blocks.paragraph(words("traceability.no-equipment"), "missing")]
    rows: list[list[Cell]] = []
    for each in file.equipment:
        made = " ".join(name(part) for part in (each.manufacturer, each.model) if part is not None)
        what = name(found.spoken(each.name, language)) + (f", {made}" if made else "")
        rows.append([what, name(each.serial), name(each.certificate or "–"), name(each.certified_by or "–")])
    heads = [words(f"column.{key}") for key in ("standard", "serial", "certificate", "certified-by")]
    return [*page, blocks.table(heads, rows, [3, 2, 2, 3], left=4, size_pt=8.5)]


def _environment(found: Laboratory, words: Words) -> list[Block]:
    """The room, as the laboratory says it."""
    given = found.file.environment
    said = [words("environment.room-temperature", shown=_condition(given.temperature))]
    if given.humidity is not None:
        said.append(words("environment.room-humidity", shown=_condition(given.humidity)))
    page = [blocks.heading(words("paper.conditions")), blocks.paragraph(" ".join(said))]
    if given.remark is not None:
        page.append(blocks.paragraph(name(found.spoken(given.remark, words.language))))
    return page


def _condition(given: TemperatureCondition | HumidityCondition) -> str:
    if given.value is not None:
        shown = f"{given.value:g} {given.unit}, u = {given.u:g} {'K' if given.unit != '%' else '%'}"
    else:
        shown = f"{given.low:g} … {given.high:g} {given.unit}"
    return shown.replace(" ", "\u00a0")


def people(content: Content) -> list[list[str]]:
    """Who signs, the main signer first: name and role; an empty line where nobody is named."""
    if content.laboratory is None:
        return [[" ", " "]]
    persons = sorted(content.laboratory.file.person, key=lambda each: not each.main_signer)
    return [[name(each.name), clean(each.role)] for each in persons]
