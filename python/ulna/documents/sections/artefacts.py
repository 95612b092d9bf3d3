"""What was touched, and what is calibrated of it."""

from __future__ import annotations

from ulna.documents.content.artefacts import ArtefactRow
from ulna.documents.content.content import Content
from ulna.documents.languages.text import NONE, Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.documents.sections.lacking import lacking
from ulna.ground.digits import uncertainty

COLUMNS = ("artefact", "kind", "calibrated", "u", "placements", "count")


def artefacts(content: Content, words: Words) -> list[Block]:
    """One row each, and of which no uncertainty is stated."""
    rows = [_artefact(row, words) for row in content.artefacts]
    page: list[Block] = [
        table("artefacts", words("section.artefacts"), words, COLUMNS, rows, left=4),
        Paragraph(words("artefacts.note"), "note"),
    ]
    without = [row.name for row in content.artefacts if row.dimension is not None and row.u_mm == 0.0]
    if without:
        page.append(Paragraph(words("artefacts.no-u", names=", ".join(without)), "missing"))
    return page + lacking(content, words, "study")


def _artefact(row: ArtefactRow, words: Words) -> list[Text]:
    what, u = _calibrated(row, words)
    if row.frame == "arm":
        what = joined([what, words("artefact.frame-arm")], ", ")
    return [named(row.name), words(f"kind.{row.kind}"), what, u, own(row.placements), own(row.readings)]


def _calibrated(row: ArtefactRow, words: Words) -> tuple[Text, Text]:
    """What of it, and with which u."""
    if row.u_mm is None:
        return words("dimension.unknown"), words("dimension.unknown")
    if row.dimension is None:
        return words("dimension.none"), NONE
    value = own("" if row.value_mm is None else f"{row.value_mm:.10g}")
    what = words(f"dimension.{row.dimension}", value=value, features=row.features)
    return what, own(f"{uncertainty(row.u_mm)} mm") if row.u_mm else words("artefact.u-none")
