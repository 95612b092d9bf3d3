"""Before and after, on fitted and held-out readings."""

from __future__ import annotations

import math

from ulna.documents.content.content import Content
from ulna.documents.content.held_out import CAUTIONS
from ulna.documents.content.quality import QualityRow
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.ground.digits import figure_mm

#: measure of a `Summary` → its part of the key of a column
MEASURES = {"mean_mm": "mean", "rms_mm": "rms", "two_sigma_mm": "sigma", "max_mm": "max"}


def quality(content: Content, words: Words) -> list[Block]:
    """The before/after table, what was held out and what is missing."""
    columns = [f"{what}-{when}" for what in MEASURES.values() for when in ("before", "after")]
    rows = [
        [words(f"quantity.{row.quantity}"), words(f"readings.{row.readings}"), *_cells(row)] for row in content.quality
    ]
    return [
        table("quality", words("section.quality"), words, ["quantity", "readings", *columns], rows, left=2),
        Paragraph(words("quality.note"), "note"),
        *(Paragraph(words.say(each), "missing" if each.key in CAUTIONS else "plain") for each in content.held_out),
    ]


def _cells(row: QualityRow) -> list[Text]:
    cells = []
    for what in MEASURES:
        for each in (row.before, row.after):
            value = math.nan if each is None else float(getattr(each, what))
            cells.append(own("–" if math.isnan(value) else figure_mm(value)))
    return cells
