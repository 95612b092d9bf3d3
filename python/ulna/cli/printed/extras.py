"""Blocks beyond geometry, and whether they earned their place."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.extras import JudgedExtra
from ulna.cli.printed.figures import WORDS
from ulna.cli.printed.tables import table
from ulna.ground.digits import figure_mm, uncertainty

_VERDICTS = {"earned": "earned its place", "undecided": "cannot be told", "not-earned": "made it worse"}


def judged_extras(extras: Sequence[JudgedExtra]) -> list[RenderableType]:
    """One row per block: the error left out without it and with it; nothing where none was judged."""
    if not extras:
        return []
    rows = [
        (
            entry.extra if entry.order is None else f"… order {entry.order} alone",
            figure_mm(entry.without_mm),
            figure_mm(entry.with_mm),
            figure_mm(entry.better_by_mm),
            uncertainty(entry.u_better_by_mm),
            _VERDICTS[entry.verdict],
        )
        for entry in extras
    ]
    heads = ("", "without / mm", "with / mm", "better by", "± u", "")
    made = table(f"Did the extras earn their place? {WORDS[extras[0].figure].capitalize()}, left out", heads, rows)
    made.columns[5].justify = "left"
    first = extras[0]
    text = (
        f"Refitted without each of {first.groups} groups ({first.by}), with each extra and with it held; u: standard "
    )
    text += "error over the groups."
    if any(entry.verdict != "earned" for entry in extras):
        text += " What did not earn its place is better left out of fit.extras or fit.harmonics."
    return ["", made, Text(text)]
