"""The head of a work sheet: what is measured with what, lines for the hand, and how to read the tables."""

from __future__ import annotations

from pathlib import Path

from ulna.artefacts.kinds import kind_of
from ulna.documents.languages.text import Name, Text
from ulna.documents.languages.words import Words
from ulna.documents.pdf.text import Cell, cell
from ulna.ground.digits import fixed
from ulna.planning.outcome import Plan
from ulna.planning.touchable import touchable

BLANK = "\u00a0" * 2 + "_" * 20
"""Room for the hand."""
HAND = ("date", "operator", "temperature", "serial")


def facts(plan: Plan, words: Words) -> list[tuple[Cell, list[Cell]]]:
    """What and its value; lines to be filled in by hand last."""
    spec, language = plan.spec, words.language

    def row(key: str, *values: Text) -> tuple[Cell, list[Cell]]:
        return cell(words(key), language), [cell(value, language) for value in values]

    probe = spec.probe or next(iter(plan.arm.probes))
    found = [
        row("sheet.arm", (Name(plan.arm.name),)),
        row("sheet.plan", (Name(Path(spec.label).name),)),
        row(
            "sheet.artefact", (Name(spec.artefact.name), " (", *words(f"kind.{spec.artefact.kind}"), *_sizes(plan), ")")
        ),
        row("sheet.probe", (Name(probe),)),
        row("sheet.work", words("sheet.counts", measurements=spec.choose, stands=len(plan.stands))),
    ]
    return [*found, *(row(f"sheet.{key}", (BLANK,)) for key in HAND)]


def notes(plan: Plan, words: Words) -> list[Cell]:
    """How coordinates and directions count, and how near is near enough."""
    within = plan.spec.within
    table = "0" if within is None else f"{within.table_mm:g}"
    keys = [words("sheet.note-frame", table=(table,)), words("sheet.note-near"), words("sheet.note-elbow")]
    if touchable(plan.spec, plan.arm, plan.arm.probe_index(plan.spec.probe)).outward is not None:
        keys.append(words("sheet.note-surface"))
    return [cell(each, words.language) for each in keys]


def _sizes(plan: Plan) -> Text:
    """Its dimensions in mm."""
    sizes = [each for each in kind_of(plan.spec.artefact).dimensions(plan.spec.artefact) if each.unit == "mm"]
    return tuple(f", {fixed(each.value, 3)} mm" for each in sizes)
