"""Blocks of sections as what the template can set: one function for each kind."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.pdf import blocks
from ulna.documents.pdf.drawings import draw
from ulna.documents.pdf.layout import LAYOUTS
from ulna.documents.pdf.text import Cell, cell, line
from ulna.documents.sections.blocks import Block, Drawing, Drawings, Facts, Heading, Listed, Paragraph, Table, Tone

#: tone of a paragraph → its style
STYLES: dict[Tone, str] = {"plain": "plain", "note": "note", "missing": "missing", "good": "good", "bad": "bad"}


@dataclass(frozen=True)
class Setting:
    """What is set, and in which language."""

    content: Content
    words: Words

    def all(self, found: Sequence[Block]) -> list[blocks.Block]:
        """One after the other. A note that plots follow is kept with them."""
        made = [self.one(block) for block in found]
        for (first, second), ready in zip(pairwise(found), made, strict=False):
            if isinstance(first, Paragraph) and first.tone == "note" and isinstance(second, Drawings):
                ready["style"] = "lead"
        return made

    def one(self, block: Block) -> blocks.Block:
        """Errors: KeyError for a block that paper does not know."""
        return _SET[type(block)](self, block)

    def line(self, text: Text) -> str:
        """As one string."""
        return line(text, self.words.language)

    def cell(self, text: Text) -> Cell:
        """With what styles paper has."""
        return cell(text, self.words.language)


def _heading(to: Setting, it: Heading) -> blocks.Block:
    return blocks.heading(to.line(it.text), 2)


def _paragraph(to: Setting, it: Paragraph) -> blocks.Block:
    return blocks.paragraph(to.cell(it.text), STYLES[it.tone])


def _listed(to: Setting, it: Listed) -> blocks.Block:
    return blocks.listed([to.cell(each) for each in it.items])


def _facts(to: Setting, it: Facts) -> blocks.Block:
    return blocks.facts([(to.cell(row.what), [to.cell(line) for line in row.lines]) for row in it.rows])


def _table(to: Setting, it: Table) -> blocks.Block:
    layout = LAYOUTS[it.name]
    kept = it.only(layout.widths)
    return blocks.table(
        [to.line(head) for head in kept.heads],
        [[to.cell(each) for each in row] for row in kept.rows],
        [layout.widths[key] for key in kept.columns],
        kept.left,
        layout.size_pt,
    )


def _drawings(to: Setting, it: Drawings) -> blocks.Block:
    return blocks.plots([_plot(to, each) for each in it.drawings], 2 if it.narrow else 1)


def _plot(to: Setting, drawing: Drawing) -> dict[str, str]:
    """Where a heading stands above a plot on the screen, it begins the caption on paper."""
    svg, said = draw(drawing, to.content, to.words)
    heading: Text = (*drawing.heading, ":") if drawing.heading else ()
    return blocks.plot(svg, to.line(joined([heading, drawing.caption, *said], " ")))


#: kind of block → how it is set
_SET: dict[type, Callable[[Setting, Any], blocks.Block]] = {
    Heading: _heading,
    Paragraph: _paragraph,
    Listed: _listed,
    Facts: _facts,
    Table: _table,
    Drawings: _drawings,
}
