"""Who answers for the document: a draft says that it is one, a certificate that was issued by whom."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.laboratory.issued import Issued
from ulna.documents.languages.text import Text, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Fact, Facts, Paragraph, own


def signature(content: Content, words: Words) -> list[Block]:
    """What stands above the signatures, or in their place."""
    made = content.provenance
    if content.issued is None:
        found: Block = Paragraph(words("paper.draft-note", program=made.program, version=made.version))
    else:
        found = Facts(_issued(content.issued, words))
    return [found, Paragraph(words("paper.decimals"), "note")]


def _issued(issued: Issued, words: Words) -> list[Fact]:
    rows: dict[str, Text] = {"issued": own(issued.day.isoformat()), "issued-by": named(issued.issued_by)}
    rows["approved-by"] = named(issued.authorised_by)
    return [Fact(key, words(f"laboratory.{key}"), [text]) for key, text in rows.items()]
