"""How objects show themselves at a prompt and in a notebook: what they are, in one screen, and never all they hold.

A class says what is to be told of it (`about`); here it becomes text, or HTML without a colour of its own, so that it
reads as well on a dark page as on a light one.
"""

from __future__ import annotations

import html
import unicodedata
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

WIDE = 80
"""Columns of a screen."""
MOST_ROWS = 10
"""Of a table in a text; of more the first and the last are shown."""
MOST_ROWS_HTML = 30
MOST_NOTES = 4
_LINE = "border-bottom:1px solid rgba(128,128,128,.5)"
_CELL = "padding:.15em .8em .15em 0"


@dataclass(frozen=True)
class Table:
    """Some rows."""

    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    title: str = ""
    texts: int = 1
    """How many columns from the left are words; the others are numbers and stand to the right."""


@dataclass(frozen=True)
class About:
    """What is to be told of an object."""

    title: str
    """What it is: "Arm 'Platinum': 7 joints, reach 1208 mm"."""
    facts: Mapping[str, str] = field(default_factory=dict)
    """What → how it is."""
    tables: Sequence[Table] = ()
    notes: Sequence[str] = ()
    """Sentences."""


class Shown(ABC):
    """What shows itself. A dataclass that is one says `repr=False`."""

    @abstractmethod
    def about(self) -> About:
        """What is to be told of it."""

    def __repr__(self) -> str:
        return as_text(self.about())

    def _repr_html_(self) -> str:
        return as_html(self.about())


def as_text(about: About) -> str:
    """Lines of at most `WIDE` columns; a table that is wider stays whole."""
    lines = _wrapped(about.title, "")
    wide = max(map(_width, about.facts), default=0)
    for what, how in about.facts.items():
        head = f"  {_padded(what, wide)}  "
        lines += _wrapped(how, head)
    for table in about.tables:
        lines += _table_lines(table)
    for note in about.notes[:MOST_NOTES]:
        lines += _wrapped(note, "  ! ")
    if len(about.notes) > MOST_NOTES:
        lines.append(f"  ! and {len(about.notes) - MOST_NOTES} more remarks")
    return "\n".join(lines)


def as_html(about: About) -> str:
    """One block. Everything is escaped; the page's own colours and letters."""
    parts = [f"<p style='margin:.3em 0'><strong>{_escaped(about.title)}</strong></p>"]
    if about.facts:
        rows = [(what, how) for what, how in about.facts.items()]
        parts.append(_html_table(Table((), rows, texts=2)))
    parts += [_html_table(table) for table in about.tables]
    parts += [f"<p style='margin:.3em 0'>{_escaped(note)}</p>" for note in about.notes]
    return f"<div class='ulna' style='overflow-x:auto'>{''.join(parts)}</div>"


def _kept(count: int, most: int) -> tuple[list[int], int]:
    """Which of so many rows are shown, None's place being after the first; and how many are not."""
    if count <= most:
        return list(range(count)), 0
    first = most - most // 3
    return [*range(first), *range(count - (most - first), count)], count - most


def _with_gap(table: Table, most: int) -> tuple[list[Sequence[str]], int | None, int]:
    """The rows that are shown, after which of them some are left out, and how many."""
    kept, left_out = _kept(len(table.rows), most)
    return [table.rows[k] for k in kept], (most - most // 3 if left_out else None), left_out


def _table_lines(table: Table) -> list[str]:
    rows, gap, left_out = _with_gap(table, MOST_ROWS)
    every = [table.heads, *rows] if any(table.heads) else rows
    wide = [max((_width(row[k]) for row in every), default=0) for k in range(len(every[0]) if every else 0)]

    def line(row: Sequence[str]) -> str:
        cells = [_padded(cell, wide[k], right=k >= table.texts) for k, cell in enumerate(row)]
        return ("  " + "  ".join(cells)).rstrip()

    lines = [f"  {table.title}"] if table.title else []
    lines += [line(table.heads)] if any(table.heads) else []
    for number, row in enumerate(rows):
        if number == gap:
            lines.append(f"  … {left_out} more …")
        lines.append(line(row))
    return lines


def _html_table(table: Table) -> str:
    rows, gap, left_out = _with_gap(table, MOST_ROWS_HTML)

    def cells(row: Sequence[str], tag: str) -> str:
        found = []
        for k, cell in enumerate(row):
            side = "left" if k < table.texts else "right"
            style = f"text-align:{side};{_CELL}" + (f";{_LINE}" if tag == "th" else "")
            found.append(f"<{tag} style='{style}'>{_escaped(cell)}</{tag}>")
        return f"<tr>{''.join(found)}</tr>"

    title = f"<p style='margin:.6em 0 .1em'><em>{_escaped(table.title)}</em></p>" if table.title else ""
    head = f"<thead>{cells(table.heads, 'th')}</thead>" if any(table.heads) else ""
    body = []
    for number, row in enumerate(rows):
        if number == gap:
            body.append(f"<tr><td colspan='{len(row)}' style='{_CELL}'>… {left_out} more …</td></tr>")
        body.append(cells(row, "td"))
    return f"{title}<table style='border-collapse:collapse'>{head}<tbody>{''.join(body)}</tbody></table>"


def _escaped(text: str) -> str:
    return html.escape(_printable(text))


def _printable(text: str) -> str:
    """Names come from files of others: nothing in them may end a line or turn the direction of letters."""
    return "".join(each if each.isprintable() else "?" for each in text)


def _width(text: str) -> int:
    """Columns that a text takes: letters of East Asia take two."""
    return sum(2 if unicodedata.east_asian_width(each) in "WF" else 1 for each in text)


def _padded(text: str, wide: int, right: bool = False) -> str:
    text = _printable(text)
    gap = " " * max(wide - _width(text), 0)
    return gap + text if right else text + gap


def _wrapped(text: str, head: str) -> list[str]:
    """A text behind a head, its further lines indented as far."""
    lines: list[str] = []
    line, indent = head, " " * (_width(head) or 2)
    for word in _printable(text).split(" "):
        if _width(line) + _width(word) > WIDE and line.strip() != head.strip():
            lines.append(line.rstrip())
            line = indent
        line += word + " "
    return [*lines, line.rstrip()]
