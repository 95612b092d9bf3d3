"""What `ulna check` prints."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.checking.check import Check, said_of
from ulna.checking.outcome import Checked
from ulna.cli.printed.tables import heading, listed, table
from ulna.cli.printed.verification import WORDS
from ulna.ground.digits import fixed, uncertainty


def check_report(found: Check) -> list[RenderableType]:
    """Figures with limit and history, what departs from the protocol, what to try."""
    by = "" if found.operator is None else f", by {found.operator}"
    parts: list[RenderableType] = [
        Text(f"Arm: {found.verification.arm}"),
        Text(f"Check '{found.protocol.file.name}', measured {found.time:%Y-%m-%d %H:%M}{by}"),
        Text(found.verification.rule.text),
        "",
        table("Figures", ("", "µm", "u\nµm", "limit\nµm", "verdict"), [_row(each) for each in found.figures]),
    ]
    if any(each.history is not None for each in found.figures):
        heads = ("", "µm", "before\nµm", "lower\nµm", "upper\nµm", "average\nµm", "")
        parts += ["", table(_title(found), heads, [_past(each) for each in found.figures])]
    notes = [(f"{each.called}: {note}",) for each in found.figures if each.history for note in each.history.notes]
    if notes:
        parts += ["", heading("Figures in a row, which chance makes now and then"), listed(notes)]
    if found.departures:
        parts += ["", heading("Other than the protocol counts"), listed((text,) for text in found.departures)]
    whys = {each.judged.decided.why for each in found.figures} - {None}
    if whys:
        parts += [
            "",
            heading("Without a verdict"),
            listed((f"{why}: {_of(found, why)}",) for why in sorted(whys, key=str)),
        ]
    for each in found.advice:
        parts += [
            "",
            heading(f"{each.test}: {'; '.join(each.why)}"),
            Text(f"Of {'; '.join(each.figures)}. In this order:"),
            listed((step,) for step in each.steps),
        ]
    return [*parts, "", Text(f"On the whole: {_whole(found)}.", style="bold")]


def _row(found: Checked) -> list[str]:
    judged = found.judged
    u_mm = judged.single.budget.u_mm
    return [
        found.called,
        _um(judged.single.value_mm),
        "–" if u_mm is None else uncertainty(1000.0 * u_mm),
        _um(judged.limit_mm),
        WORDS[judged.decided.verdict],
    ]


def _title(found: Check) -> str:
    earlier = len(found.history)
    return f"History: {earlier} earlier check{'s' * (earlier != 1)}"


def _past(found: Checked) -> list[str]:
    past, value = found.history, _um(found.judged.single.value_mm)
    if past is None:
        return [found.called, value, *["–"] * 5]
    edges = (past.centre, past.lower, past.upper, past.average)
    return [found.called, value, *map(_um, edges), said_of(past)]


def _of(found: Check, why: str | None) -> str:
    return ", ".join(dict.fromkeys(each.definition.key for each in found.figures if each.judged.decided.why == why))


def _um(value_mm: float | None) -> str:
    return "–" if value_mm is None else fixed(1000.0 * value_mm, 1)


def _whole(found: Check) -> str:
    limits = "no limit stated" if found.verdict is None else f"limits: {WORDS[found.verdict]}"
    if not any(each.history is not None for each in found.figures):
        return f"{limits}; no history was named"
    words = {True: "in control", False: "OUT OF CONTROL", None: "too few earlier checks to say"}
    return f"{limits}; history: {words[found.in_control]}"
