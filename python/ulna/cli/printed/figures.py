"""The metrologist's figures as tables: before and after, and per artefact and placement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.artefacts.quantities import NAMES
from ulna.calibration.placements import PlacementFigures, without_repeats
from ulna.cli.printed.tables import table
from ulna.ground.digits import figure_mm

MOST_ROWS = 24

WORDS = {
    "seat_scatter_mean_mm": "seat scatter, mean",
    "seat_scatter_rms_mm": "seat scatter, rms",
    "seat_scatter_max_mm": "seat scatter, max",
    "length_error_mean_mm": "length error, signed mean",
    "length_error_mean_abs_mm": "length error, mean size",
    "length_error_rms_mm": "length error, rms",
    "length_error_max_abs_mm": "length error, max size",
    "coordinate_error_mean_mm": "coordinate error, mean",
    "coordinate_error_rms_mm": "coordinate error, rms",
    "coordinate_error_max_mm": "coordinate error, max",
    "form_mm": "form, largest",
    "diameter_error_mm": "diameter error, largest",
}
_SHORT = {
    "seat_scatter_mean_mm": "seat\nmean",
    "seat_scatter_max_mm": "seat\nmax",
    "length_error_mean_mm": "length\nmean",
    "length_error_mean_abs_mm": "length\nsize",
    "length_error_max_abs_mm": "length\nmax",
    "coordinate_error_mean_mm": "coord.\nmean",
    "coordinate_error_max_mm": "coord.\nmax",
    "form_mm": "form",
    "diameter_error_mm": "diam.\nerror",
}


def before_after(
    title: str, before: Mapping[str, float], after: Mapping[str, float], more: Sequence[Sequence[str]] = ()
) -> RenderableType:
    """Each figure that there is, before and after, mm; `more` are further rows."""
    rows = [(WORDS[name], _cell(before, name), _cell(after, name)) for name in NAMES if name in before or name in after]
    return table(title, ("", "before / mm", "after / mm"), [*rows, *more])


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
