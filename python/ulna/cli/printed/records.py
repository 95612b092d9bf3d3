"""What the commands of `ulna record` print."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import table
from ulna.records.due import Due
from ulna.records.history import Happening
from ulna.records.impact import Impact
from ulna.records.verify import Verified

_LATEST = 30
_MOST_WRONG = 40


def listed_report(found: Sequence[Mapping[str, Any]]) -> list[RenderableType]:
    """Equipment as it is now."""
    if not found:
        return [Text("Nothing is registered yet. Register an arm: ulna record arm NAME --serial NUMBER")]
    names = ("name", "kind", "state", "serial", "model", "location")
    rows = [[str(row[name] or "") for name in names] for row in found]
    return [table("", names, rows, left=len(names))]


def history_report(name: str, found: Sequence[Happening], everything: bool) -> list[RenderableType]:
    """By day; a text that is too long for the line runs over."""
    shown = found if everything else found[-_LATEST:]
    parts: list[RenderableType] = []
    if len(shown) < len(found):
        parts.append(Text(f"{len(found) - len(shown)} earlier: --all."))
    return [*parts, *_lines(name, shown)]


def _lines(title: str, found: Sequence[Happening]) -> list[RenderableType]:
    rows = [
        (each.at[:10], each.what, each.text if each.sha256 is None else f"{each.text} ({each.sha256[:8]})", each.by)
        for each in found
    ]
    return [table(title, ("day", "", "", "by"), rows, left=4)]


def due_report(found: Sequence[Due]) -> list[RenderableType]:
    """The soonest first."""
    if not found:
        return [Text("Nothing is registered yet.")]
    rows = [
        (each.name, each.kind, each.state, each.why, each.due or "-", "-" if each.days is None else str(each.days))
        for each in found
    ]
    return [table("", ("name", "kind", "state", "why", "due", "days"), rows, left=4)]


def impact_report(found: Impact) -> list[RenderableType]:
    """From when to when, what, and which certificates."""
    good = "never found good before" if found.good is None else f"good on {found.good[:10]}"
    parts: list[RenderableType] = [Text(f"{found.name}: {good}, bad on {found.bad[:10]}: {found.why}.")]
    if not found.touched:
        return [*parts, Text("Nothing was filed or issued meanwhile.")]
    parts += ["", *_lines("Meanwhile", found.touched)]
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
    return [*parts, Text(f"Head: {found.head}")] if found.head else parts
