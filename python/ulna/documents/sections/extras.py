"""Blocks beyond geometry and their verdicts."""

from __future__ import annotations

from ulna.calibration.extras import JudgedExtra
from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.ground.digits import figure_mm, uncertainty

COLUMNS = ("extra", "quantity", "verdict", "without", "with", "better", "u-better")


def extras(content: Content, words: Words) -> list[Block]:
    """Nothing where none was asked for."""
    if not content.extras:
        return []
    rows = [_extra(each, words) for each in content.extras]
    return [
        table("extras", words("section.extras"), words, COLUMNS, rows, left=3),
        Paragraph(words("extras.note"), "note"),
    ]


def _extra(each: JudgedExtra, words: Words) -> list[Text]:
    order: Text = () if each.order is None else words("extra.order", order=each.order)
    errors = [own(figure_mm(value)) for value in (each.without_mm, each.with_mm, each.better_by_mm)]
    return [
        joined([words(f"extra.{each.extra}"), order], ", "),
        words(f"figure.{each.figure}"),
        words(f"verdict.{each.verdict}"),
        *errors,
        own(uncertainty(each.u_better_by_mm)),
    ]
