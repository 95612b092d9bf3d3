"""The printed report, whole: first page, results, plots, signatures."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ulna.documents.content.content import Content
from ulna.documents.languages.languages import language_of
from ulna.documents.languages.text import END, ISOLATE, Code, plain
from ulna.documents.languages.words import Words, dictionary
from ulna.documents.pdf import blocks, head, order
from ulna.documents.pdf.canvas import looks
from ulna.documents.pdf.fonts import Chosen, choose
from ulna.documents.pdf.setting import Setting
from ulna.documents.pdf.text import clean, line, name
from ulna.documents.pdf.typeset import typeset
from ulna.documents.sections.blocks import Drawing

#: not on paper as they are: the certificate in XML says them
_ELSEWHERE = "dcc."
_NUMBER = (Code(""),)
"""Where the template puts the number of a page in."""


def render(content: Content, language: str = "en", fonts: Path | None = None, annex: bool = True) -> bytes:
    """The PDF (PDF/A-2a, PDF/UA-1). The same content gives the same bytes.

    fonts: a folder with fonts to look at before those of the machine; annex: with what stands behind the certificate,
    how the fit went and its plots. Raises UlnaInputError where no font has a
    character that the page needs, or the laboratory file has no text in this language.
    """
    data, chosen = certificate(content, language, fonts, annex)
    return typeset(data, chosen)


def certificate(
    content: Content, language: str, fonts: Path | None = None, annex: bool = True
) -> tuple[dict[str, Any], Chosen]:
    """What the template is given, and the fonts that have all of it."""
    words = Words(language)
    data = _about(content, words)
    parts = order.parts(content, words, annex)
    behind = order.annexed(content, words) if annex else []
    # labels of plots are words of the dictionary: all of them, so that fonts are known before they are drawn
    own = [text for key, text in dictionary(language).items() if not key.startswith(_ELSEWHERE)]
    chosen = choose([*texts_in(data), *texts_in([*parts, *behind]), *own], fonts)
    data["fonts"] = chosen.order(language)
    data["logo"] = head.logo(content, words)
    to = Setting(content, words)
    with looks([family.regular for family in chosen.more]):
        data["blocks"] = [each for part in parts for each in _set(part, to)]
        data["annex"] = [each for part in behind for each in _set(part, to)]
    if content.issued is None:
        data["blocks"].append({"kind": "signatures", "people": head.people(content, words)})
    return data, chosen


def _about(content: Content, words: Words) -> dict[str, Any]:
    """All but the text."""
    made = content.provenance
    signed = content.laboratory is not None

    def say(key: str) -> str:
        return line(words(key), words.language)

    program = name(f"{made.program} {made.version}")
    return {
        "lang": words.language,
        "region": language_of(words.language).region,
        "title": say("paper.title") if signed else say("title"),
        "author": (head.issuer(content, words) or program).strip(ISOLATE + END),
        "issuer": head.running_issuer(content, words) or say("title"),
        "number": head.identifier(content),
        "date": head.date(content),
        "program": program,
        "letterhead": head.letterhead(content, words),
        "people": head.people(content, words),
        "labels": {
            "number": say("laboratory.identifier") if signed else say("provenance.result"),
            "draft": say("paper.draft") if content.issued is None else "",
            "sign": say("paper.sign"),
            "page": page_label(words),
            "annex": say("paper.annex"),
            "end": say("paper.end") if signed else say("paper.end-report"),
        },
    }


def _set(part: order.Part, to: Setting) -> list[blocks.Block]:
    heading = [blocks.heading(to.line(part.heading))] if part.heading else []
    return [*heading, *to.all(part.blocks)]


def page_label(words: Words) -> list[str]:
    """The text before, between and after the two numbers, which the template puts in."""
    found: list[str] = [""]
    for piece in words("paper.page", page=_NUMBER, pages=_NUMBER):
        if piece == _NUMBER[0]:
            found.append("")
        else:
            found[-1] += plain((piece,))
    return found


def texts_in(value: Any) -> Iterator[str]:
    """All strings within, as they are shown; of plots what is said of them, not what is drawn."""
    if isinstance(value, str):
        yield clean(value)
    elif isinstance(value, dict):
        yield from texts_in(list(value.values()))
    elif isinstance(value, Drawing):
        yield from texts_in([value.caption, value.heading])
    elif dataclasses.is_dataclass(value):
        yield from texts_in([getattr(value, field.name) for field in dataclasses.fields(value)])
    elif isinstance(value, Sequence):
        for each in value:
            yield from texts_in(each)
