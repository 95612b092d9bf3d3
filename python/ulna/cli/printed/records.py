"""What the commands of `ulna record` print."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from ulna.cli.printed.tables import table
from ulna.records.due import Due
from ulna.records.history import Happening
from ulna.records.impact import Impact
from ulna.records.verify import Verified

_LATEST = 30
_NARROWEST = 16
_GAP = 2
"""Between the columns of a table."""
_MOST_WRONG = 40


def listed_report(found: Sequence[Mapping[str, Any]], columns: int) -> list[RenderableType]:
    """Equipment as it is now; columns: of the terminal."""
    if not found:
        return [Text("Nothing is registered yet. Register an arm: ulna record arm NAME --serial NUMBER")]
    names = ("name", "kind", "state", "serial", "model", "location")
    rows = [[str(row[name] or "") for name in names] for row in found]
    return [table("", names, _broken(rows, names.index("location"), columns, names), left=len(names))]


def history_report(name: str, found: Sequence[Happening], everything: bool, columns: int) -> list[RenderableType]:
    """By day; columns: of the terminal."""
    shown = found if everything else found[-_LATEST:]
    parts: list[RenderableType] = []
    if len(shown) < len(found):
        parts.append(Text(f"{len(found) - len(shown)} earlier: --all."))
    return [*parts, *_lines(name, shown, columns)]


def _lines(title: str, found: Sequence[Happening], columns: int) -> list[RenderableType]:
    """A row each; a text that is longer than there is room for goes on below."""
    rows = [
        (each.at[:10], each.what, each.text if each.sha256 is None else f"{each.text} ({each.sha256[:8]})", each.by)
        for each in found
    ]
    heads = ("day", "", "", "by")
    return [table(title, heads, _broken(rows, 2, columns, heads), left=4)]


def _broken(rows: Sequence[Sequence[str]], at: int, columns: int, heads: Sequence[str]) -> list[list[str]]:
    """Rows whose text in one column goes on in rows below it, so that they have room."""
    widths = [max((len(row[k]) for row in [heads, *rows]), default=0) for k in range(len(heads))]
    room = max(columns - sum(widths) + widths[at] - _GAP * (len(heads) - 1), _NARROWEST)
    return [
        [line if k == at else each * (number == 0) for k, each in enumerate(row)]
        for row in rows
        for number, line in enumerate(textwrap.wrap(row[at], room) or [""])
    ]


def due_report(found: Sequence[Due], columns: int) -> list[RenderableType]:
    """The soonest first; columns: of the terminal."""
    if not found:
        return [Text("Nothing is registered yet.")]
    rows = [
        (each.name, each.kind, each.state, each.why, each.due or "-", "-" if each.days is None else str(each.days))
        for each in found
    ]
    heads = ("name", "kind", "state", "why", "due", "days")
    return [table("", heads, _broken(rows, heads.index("why"), columns, heads), left=4)]


def impact_report(found: Impact, columns: int) -> list[RenderableType]:
    """From when to when, what, and which certificates."""
    good = "not known to be good before" if found.good is None else f"good on {found.good[:10]}"
    parts: list[RenderableType] = [Text(f"{found.name}: {good}, bad on {found.bad[:10]}: {found.why}.")]
    if not found.touched:
        return [*parts, Text("Nothing was filed or issued meanwhile.")]
    parts += ["", *_lines("Meanwhile", found.touched, columns)]
    said = ", ".join(found.certificates) or "none"
    return [*parts, Text(f"Certificates that rest on it: {said}.")]


def verified_report(found: Verified) -> list[RenderableType]:
    """What was looked at, what is wrong, the head."""
    looked = f"{found.entries} entries, {found.files} files, {found.rows} rows looked at"
    if found.good:
        parts: list[RenderableType] = [Text(f"{looked}: all as it was written.", style="green")]
    else:
        count = len(found.wrong)
        parts = [Text(f"{looked}: {count} thing{'s' * (count != 1)} wrong.", style="red")]
        parts += [Text(f"- {each}") for each in found.wrong[:_MOST_WRONG]]
        if count > _MOST_WRONG:
            parts.append(Text(f"- and {count - _MOST_WRONG} more"))
    parts += [Text(f"Remark: {each}.") for each in found.remarks]
    if found.head:
        whole = Table.grid()  # a text would be broken where the terminal ends, and this one is to be copied
        whole.add_column(no_wrap=True)
        whole.add_row(f"Head: {found.head}")
        parts.append(whole)
    return parts
