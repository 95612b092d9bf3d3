"""Before and after, on fitted and held-out readings."""

from __future__ import annotations

import math

from ulna.calibration.coverage import Coverage, P, Share
from ulna.documents.content.content import Content
from ulna.documents.content.held_out import CAUTIONS
from ulna.documents.content.quality import QualityRow
from ulna.documents.languages.text import Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Heading, Paragraph, own, table
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
        *_coverage(content, words),
        *(Paragraph(words.say(each), "missing" if each.key in CAUTIONS else "plain") for each in content.held_out),
    ]


def _coverage(content: Content, words: Words) -> list[Block]:
    """How many points and lengths lie within what was stated of them; where too few or far too many do, in words."""
    if not content.coverage:
        return []
    rows = [
        [words(f"coverage.{name}"), words(f"readings.{judged.readings}"), *map(own, _counted(share))]
        for judged in content.coverage
        for name, share in judged.coverage.shares
    ]
    columns = ["quantity", "readings", "judged", "inside", "share", "interval"]
    title = words("coverage.title", p=own(f"{100 * P:g}"))
    page: list[Block] = [Heading(title), table("coverage", title, words, columns, rows, left=2)]
    for judged in content.coverage:
        of, found = words(f"readings.{judged.readings}"), judged.coverage
        if found.too_small:
            page.append(Paragraph(_too_small(of, found, words), "missing"))
        elif found.too_large is not None:
            page.append(Paragraph(words("coverage.too-large", of=of, factor=own(f"{found.too_large:.2g}")), "note"))
    return [*page, Paragraph(words("coverage.note", p=own(f"{100 * P:g}")), "note")]


def _counted(share: Share) -> list[str]:
    of_chance = f"{100 * share.low:.1f} … {100 * share.high:.1f}"
    return [str(share.count), str(share.inside), f"{100 * share.share:.1f}", of_chance]


def _too_small(of: Text, found: Coverage, words: Words) -> Text:
    factors = [
        words("coverage.factor", factor=own(f"{factor:.2g}"), quantity=words(f"coverage.{name}"))
        for name, factor in found.too_small.items()
    ]
    said = words("coverage.too-small", of=of, factors=joined(factors, ", "))
    causes = [words(f"coverage.likely-{cause}") for cause in found.likely]
    return joined([said, words("coverage.likely", causes=joined(causes, "; "))], " ") if causes else said


def _cells(row: QualityRow) -> list[Text]:
    cells = []
    for what in MEASURES:
        for each in (row.before, row.after):
            value = math.nan if each is None else float(getattr(each, what))
            cells.append(own("–" if math.isnan(value) else figure_mm(value)))
    return cells
