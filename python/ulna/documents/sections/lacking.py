"""What the data do not give, said where it would stand."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph


def lacking(content: Content, words: Words, *keys: str) -> list[Block]:
    """Of these parts of the content those that are missing, and what would be needed."""
    return [Paragraph(words.say(content.missing[key]), "missing") for key in keys if key in content.missing]
