"""The metrologist's figures as tables: before and after, and per artefact and placement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.artefacts.quantities import NAMES, QUANTITIES
from ulna.calibration.placements import PlacementFigures, without_repeats
from ulna.cli.printed.tables import table
from ulna.ground.digits import figure_mm

MOST_ROWS = 24

WORDS = {name: words for quantity in QUANTITIES for name, words in quantity.words().items()}
_SHORT = {name: head for quantity in QUANTITIES for name, head in quantity.heads().items()}


def before_after(
    title: str,
    before: Mapping[str, float],
    after: Mapping[str, float],
    more: Sequence[Sequence[str]] = (),
    without: Mapping[str, float] | None = None,
    far_off: int = 0,
) -> RenderableType:
    """Each figure that there is, before and after, mm; `more` are further rows; `without`: after, without readings that
    are far off, so many."""
    names = [name for name in NAMES if name in before or name in after]
    if without is None:
        rows = [(WORDS[name], _cell(before, name), _cell(after, name)) for name in names]
        return table(title, ("", "before / mm", "after / mm"), [*rows, *more])
    rows_without = [(WORDS[name], _cell(before, name), _cell(after, name), _cell(without, name)) for name in names]
    heads = ("", "before / mm", "after / mm", f"without the\n{far_off} far off / mm")
    return table(title, heads, [*rows_without, *((*row, "–") for row in more)])


def overall(title: str, figures: Mapping[str, float]) -> RenderableType:
    """Each figure that there is, mm."""
    return table(title, ("", "mm"), [(WORDS[name], _cell(figures, name)) for name in NAMES if name in figures])


def per_placement(entries: Sequence[PlacementFigures], everything: str) -> list[RenderableType]:
    """One row per artefact and placement; of very many the first, and where the rest is (`everything`)."""
    present = {name for entry in entries for name in entry.figures}
    columns = [name for name in _SHORT if name in present]
    columns = without_repeats(entries, columns)
    heads = ["artefact", "placement", "readings", *(f"{_SHORT[name]}\nmm" for name in columns)]
    rows = [
        [entry.artefact, entry.placement, str(entry.readings), *(_cell(entry.figures, name) for name in columns)]
        for entry in entries[:MOST_ROWS]
    ]
    parts: list[RenderableType] = [table("Per artefact and placement", heads, rows, left=2)]
    if len(entries) > MOST_ROWS:
        parts.append(Text(f"… and {len(entries) - MOST_ROWS} more placements: {everything}"))
    return parts


def _cell(figures: Mapping[str, float], name: str) -> str:
    return figure_mm(figures[name]) if name in figures else "–"
