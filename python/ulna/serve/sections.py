"""Sections of a report as data, for the page: the same that HTML and PDF set."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ulna.documents.content.content import Content
from ulna.documents.html.blocks import Legend
from ulna.documents.html.page import sections_of
from ulna.documents.languages.text import Code, Command, Name, Styled, Text, plain
from ulna.documents.languages.words import Words
from ulna.documents.sections import blocks
from ulna.serve.contract import results as wire

_STYLES: dict[type, str] = {str: "plain", Name: "name", Command: "command", Code: "code"}


def sections(content: Content, language: str) -> list[wire.Section]:
    """All of them, in their order."""
    words = Words(language)
    return [
        wire.Section(key=key, title=plain(words(f"section.{key}")), blocks=blocks_said(found))
        for key, found in sections_of(content, words).items()
        if found
    ]


def blocks_said(found: Sequence[blocks.Block | Legend]) -> list[wire.Block]:
    """Some of them."""
    return [_block(each) for each in found if _shown(each)]


def _shown(block: object) -> bool:
    return not isinstance(block, Legend)  # of plots, which the report shows


def text(pieces: Text) -> wire.Text:
    """Its pieces."""
    return [_piece(piece) for piece in pieces]


def _piece(piece: Any) -> wire.Piece:
    if isinstance(piece, Styled):
        return wire.Piece(style=piece.style, text=plain(piece.text))
    return wire.Piece(style=_STYLES[type(piece)], text=piece if isinstance(piece, str) else piece.text)  # type: ignore[arg-type]


def _block(block: Any) -> wire.Block:
    return _BLOCKS[type(block)](block)


def _texts(several: Sequence[Text]) -> list[wire.Text]:
    return [text(each) for each in several]


def _table(block: blocks.Table) -> wire.TableBlock:
    return wire.TableBlock(
        name=block.name,
        label=text(block.label),
        columns=list(block.columns),
        heads=_texts(block.heads),
        rows=[_texts(row) for row in block.rows],
        left=block.left,
    )


def _facts(block: blocks.Facts) -> wire.FactsBlock:
    return wire.FactsBlock(
        rows=[wire.Fact(key=row.key, what=text(row.what), lines=_texts(row.lines)) for row in block.rows]
    )


def _tiles(block: blocks.Tiles) -> wire.TilesBlock:
    return wire.TilesBlock(
        tiles=[wire.Tile(value=text(each.value), label=text(each.label), more=text(each.more)) for each in block.tiles]
    )


_BLOCKS: dict[type, Callable[[Any], wire.Block]] = {
    blocks.Heading: lambda block: wire.HeadingBlock(text=text(block.text)),
    blocks.Paragraph: lambda block: wire.ParagraphBlock(text=text(block.text), tone=block.tone),
    blocks.Listed: lambda block: wire.ListedBlock(items=_texts(block.items)),
    blocks.Facts: _facts,
    blocks.Table: _table,
    blocks.Tiles: _tiles,
    blocks.Drawings: lambda block: wire.DrawingsBlock(
        captions=[text(each.heading or each.caption) for each in block.drawings if each.heading or each.caption]
    ),
}
"""Kind of block → the same as it goes over the wire."""
