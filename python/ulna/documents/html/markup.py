"""HTML out of text that nobody may trust: everything from files is escaped here, and nowhere else."""

from __future__ import annotations

import html
import json
import math
import re
from collections.abc import Iterable, Sequence
from typing import Any

from ulna.documents.languages.words import Words
from ulna.ground.digits import fixed, small

ISOLATE, END = "\u2068", "\u2069"
"""First-strong isolate of Unicode, for text that has no elements: right-to-left names do not turn their sentence."""


def text(value: Any) -> str:
    """Escaped, for elements and for attributes in quotes."""
    return html.escape(str(value), quote=True)


def name(value: Any) -> str:
    """A name from a file: escaped, its direction its own."""
    return f'<bdi dir="auto">{text(value)}</bdi>'


def number(value: float) -> str:
    """A number in a sentence, four digits."""
    if not math.isfinite(value):
        return "–"
    size = abs(value)
    if value == 0.0 or 1e-3 <= size < 1e6:
        return fixed(value, min(max(3 - math.floor(math.log10(size)), 0), 6)) if size else "0"
    return small(value, 3)


def in_sentence(value: Any) -> str:
    """What fills a sentence: names isolated, whole numbers as they are, others with four digits."""
    if isinstance(value, float):
        return number(value)
    return str(value) if isinstance(value, int) else name(value)


def in_figure(value: Any) -> str:
    """The same for text of a figure, which knows no elements of HTML but its entities."""
    if isinstance(value, float):
        return number(value)
    return str(value) if isinstance(value, int) else f"{ISOLATE}{html.escape(str(value), quote=False)}{END}"


def prose(given: str) -> str:
    """Our own words: escaped, `commands` as code."""
    return re.sub("`([^`]+)`", r"<code>\1</code>", html.escape(given, quote=True))


def words_for_page(language: str) -> Words:
    """The words of a language, for HTML."""
    return Words(language, prose, in_sentence)


def words_for_figures(language: str) -> Words:
    """The same for titles of axes and legends."""
    return Words(language, lambda given: html.escape(given, quote=False), in_figure)


def json_in_script(value: Any) -> str:
    """JSON that ends no script element, opens no comment and breaks no line of JavaScript."""
    found = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    return found


def paragraph(content: str, kind: str = "") -> str:
    """`content` is HTML."""
    marked = f' class="{kind}"' if kind else ""
    return f"<p{marked}>{content}</p>\n" if content else ""


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], label: str, left: int = 1, tall: bool = False) -> str:
    """Cells are HTML; the first `left` columns hold words, the others numbers. It scrolls where it is too wide, and a
    `tall` one where it is too long."""
    top = "".join(f'<th scope="col"{_side(k < left)}>{head}</th>' for k, head in enumerate(heads))
    body = []
    for row in rows:
        cells = "".join(f"<td{_side(k < left)}>{cell}</td>" for k, cell in enumerate(row))
        body.append(f"<tr>{cells}</tr>\n")
    return (
        f'<div class="scroll{" tall" if tall else ""}" role="region" tabindex="0" aria-label="{label}"><table>\n'
        f"<thead><tr>{top}</tr></thead>\n<tbody>\n{''.join(body)}</tbody></table></div>\n"
    )


def _side(left: bool) -> str:
    return ' class="l"' if left else ""


def section(key: str, words: Words, content: str) -> str:
    """A section with its heading; `content` is HTML."""
    return f'<section id="{key}"><h2>{words(f"section.{key}")}</h2>\n{content}</section>\n'
