"""The figures of each placement; of very many those with the largest errors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ulna.artefacts.quantities import NAMES
from ulna.calibration.placements import PlacementFigures, without_repeats
from ulna.documents.content.content import Content
from ulna.documents.languages.text import NONE, Text, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, Table, own
from ulna.ground.digits import figure_mm

WHERE = ("artefact", "placement", "count")


def placements(content: Content, words: Words, most: int) -> list[Block]:
    """At most `most` of them, and how many there are."""
    entries = content.placements
    there = [key for key in NAMES if any(key in entry.figures for entry in entries) and "_rms_" not in key]
    figures = without_repeats(entries, there)
    kept = _worst(entries, most)
    heads = [words(f"column.{key}") for key in WHERE] + [words(f"figure.{key}") for key in figures]
    rows = [_placement(entry, figures) for entry in kept]
    page: list[Block] = [
        Table("placements", words("section.placements"), [*WHERE, *figures], heads, rows, left=2),
        Paragraph(words("placements.note"), "note"),
    ]
    if len(kept) < len(entries):
        page.append(Paragraph(words("placements.more", shown=len(kept), count=len(entries)), "missing"))
    return page


def _worst(entries: Sequence[PlacementFigures], most: int) -> Sequence[PlacementFigures]:
    """In their order."""
    if len(entries) <= most:
        return entries
    size = [max((abs(value) for value in entry.figures.values()), default=0.0) for entry in entries]
    order = np.argsort(-np.array(size), kind="stable")[:most]
    return [entries[k] for k in sorted(order.tolist())]


def _placement(entry: PlacementFigures, figures: Sequence[str]) -> list[Text]:
    values = [own(figure_mm(entry.figures[key])) if key in entry.figures else NONE for key in figures]
    return [named(entry.artefact), named(entry.placement), own(entry.readings), *values]
