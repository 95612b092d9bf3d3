"""What `ulna cross-validate` prints."""

from __future__ import annotations

from collections.abc import Mapping

from rich.console import RenderableType
from rich.text import Text

from ulna.arm.directions import sentence
from ulna.artefacts.quantities import QUANTITIES
from ulna.calibration.cross_validate import CrossValidation
from ulna.cli.printed.coverage import coverage_report
from ulna.cli.printed.figures import MOST_ROWS, before_after
from ulna.cli.printed.tables import heading, listed, table
from ulna.ground.digits import figure_mm

#: of each quantity the first figure that a size can be read from
_SHOWN = {
    quantity.figure(next(each for each in ("mean_abs", "mean", "largest") if each in quantity.figures)): quantity.short
    for quantity in QUANTITIES
}

#: as many as a terminal of 80 columns has room for; the table over all groups has every figure
_MOST_FIGURES = 3


def cross_validation_report(found: CrossValidation) -> list[RenderableType]:
    """Per group left out, then over all groups, then whether what each fit states holds."""
    present = {name for group in found.groups for name in (*group.before, *group.after)}
    columns = [name for name in _SHOWN if name in present][:_MOST_FIGURES]
    heads = ["left out", "readings"]
    for name in columns:
        heads += [f"{_SHOWN[name]}\nbefore\nmm", "after\nmm"]
    rows = []
    for group in found.groups[:MOST_ROWS]:
        cells = [group.group + ("" if group.converged else " (!)"), str(group.readings)]
        for name in columns:
            cells += [_cell(group.before, name), _cell(group.after, name)]
        rows.append(cells)
    parts: list[RenderableType] = [
        Text(f"Refitted {len(found.groups)} times, each time judged on the group left out ({found.by}). Means."),
        "",
        table("Groups", heads, rows),
    ]
    if len(found.groups) > MOST_ROWS:
        parts.append(Text(f"… and {len(found.groups) - MOST_ROWS} more: -o DIR writes all to cross-validation.json."))
    parts += ["", before_after("Over all groups, on readings not seen", found.before, found.after)]
    parts += coverage_report(found.coverage)
    return parts + _lost_only_sometimes(found)


def _lost_only_sometimes(found: CrossValidation) -> list[RenderableType]:
    """What a group alone determines: the others lose it, and the figures suffer for it."""
    losing: dict[str, list[str]] = {}
    remedies: dict[str, str] = {}
    for group in found.groups:
        for direction in group.lost:
            if not direction.get("frame"):
                losing.setdefault(direction["because"], []).append(group.group)
                remedies[direction["because"]] = direction["remedy"]
    items = [
        (f"Without {_some(groups)}: {sentence(because)}", f"Remedy: {sentence(remedies[because])}")
        for because, groups in losing.items()
    ]
    return ["", heading("Not determined by the readings that were left"), listed(items)] if items else []


def _some(groups: list[str]) -> str:
    unique = list(dict.fromkeys(groups))
    return ", ".join(unique[:5]) + (f" and {len(unique) - 5} more" if len(unique) > 5 else "")


def _cell(figures: Mapping[str, float], name: str) -> str:
    return figure_mm(figures[name]) if name in figures else "–"
