"""What the readings determine: directions that are lost or weak, with cause and remedy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ulna.arm.directions import combination, sentence
from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined, named, styled
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Heading, Paragraph, Table, own, table
from ulna.ground.digits import uncertainty


def determined(content: Content, words: Words, brief: bool = False) -> list[Block]:
    """All directions, and what is known from priors alone. brief: without why and what would help, which is advice to
    who calibrates, and in English."""
    found = content.identification
    page: list[Block] = []
    if not found.lost:
        page.append(Paragraph(words("determined.with-priors" if found.from_prior else "determined.all")))
    for title, directions in (("determined.lost", found.lost), ("determined.weak", found.weak)):
        if directions:
            page += [Heading(words(title)), _directions(directions, words(title), words, brief)]
    if (found.lost or found.weak) and not brief and words.language != "en":
        page.append(Paragraph(words("note.english"), "note"))
    if found.from_prior:
        page.append(Paragraph(words("determined.from-prior", names=", ".join(found.from_prior))))
    return page


def _directions(directions: Sequence[Mapping[str, Any]], label: Text, words: Words, brief: bool) -> Table:
    columns = ("combination", "cause", "because", "remedy")
    made = table("directions", label, words, columns, [_direction(each, words) for each in directions], left=4)
    return made.only(columns[:2]) if brief else made


def _direction(each: Mapping[str, Any], words: Words) -> list[Text]:
    because = reason(each["because"])
    if each.get("frame"):
        because = joined([because, words("determined.frame")], " ")
    return [named(combination(each["combination"])), _cause(each, words), because, reason(each["remedy"])]


def _cause(each: Mapping[str, Any], words: Words) -> Text:
    """In words where there are any for it; of a weak direction, which has none, how well it is known."""
    cause = str(each.get("cause", ""))
    if not cause:
        return own(f"u = {uncertainty(each['u'])} {each['unit']}") if "u" in each else ()
    return words(f"cause.{cause}") if words.has(f"cause.{cause}") else named(cause)


def reason(text: str) -> Text:
    """In the core's own words, as a sentence."""
    return styled(named(sentence(text)), "english")
