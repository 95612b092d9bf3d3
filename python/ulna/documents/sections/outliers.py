"""Readings far off: all of them, of very many the farthest, none dropped silently."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ulna.documents.content.content import Content
from ulna.documents.languages.text import NONE, Text, named, number
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.ground.digits import figure_mm

PLACE = ("row", "file", "artefact", "placement", "feature", "probe")
"""Where it is: keys of an outlier of a result; what a reading has not is a dash."""


def outliers(content: Content, words: Words, most: int) -> list[Block]:
    """The `most` farthest, and how many more there are."""
    if not content.outliers:
        return [Paragraph(words("outliers.none"))]
    counted = ("counted",) if any("counted" in entry for entry in content.outliers) else ()
    columns = (*PLACE, "size", "times", *counted)
    rows = [_outlier(entry, bool(counted)) for entry in content.outliers[:most]]
    page: list[Block] = [
        table("outliers", words("section.outliers"), words, columns, rows, left=len(PLACE)),
        Paragraph(words("outliers.note"), "note"),
    ]
    more = len(content.outliers) - most
    if more > 0:
        page.append(Paragraph(words("outliers.more", more=more, shown=most), "missing"))
    return page


def _outlier(entry: Mapping[str, Any], counted: bool) -> list[Text]:
    cells = [named(entry[key]) if key in entry else NONE for key in PLACE]
    # a cell of a workbook is called so in every language; a line of a text file follows from its row
    if "!" in (entry.get("place") or ""):
        cells[0] = named(f"{entry['row']} ({entry['place']})")
    cells += [own(figure_mm(entry["norm_mm"])), own(number(float(entry["times_scatter"])))]
    return [*cells, own(number(float(entry.get("counted", 1.0))))] if counted else cells
