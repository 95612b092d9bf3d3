"""The laboratory's statement and the standards' certificates; where they are missing, that they are."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import EquipmentTable
from ulna.documents.languages.text import NONE, Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, table
from ulna.documents.sections.standards import standards

COLUMNS = ("standard", "serial", "certificate", "certified-by")


def traceability(content: Content, words: Words) -> list[Block]:
    """Only the laboratory can state it."""
    found = content.laboratory
    if found is None:
        return [Paragraph(words("traceability.not-stated"), "bad"), *standards(content, words)]
    statement = found.file.traceability
    if statement is None:
        page: list[Block] = [Paragraph(words("traceability.not-stated"), "bad")]
    else:
        page = [Paragraph(named(found.spoken(statement.statement, words.language)))]
    if not found.file.equipment:
        return [*page, Paragraph(words("traceability.no-equipment"), "missing"), *standards(content, words)]
    rows = [_standard(found, each, words) for each in found.file.equipment]
    equipment = table("equipment", words("section.traceability"), words, COLUMNS, rows, left=4)
    return [*page, equipment, *standards(content, words)]


def _standard(found: Laboratory, each: EquipmentTable, words: Words) -> list[Text]:
    made = named(*(part for part in (each.manufacturer, each.model) if part is not None))
    what = joined([named(found.spoken(each.name, words.language)), made], ", ")
    given = (each.certificate, each.certified_by)
    return [what, named(each.serial), *(NONE if part is None else named(part) for part in given)]
