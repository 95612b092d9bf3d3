"""Which model was chosen, and what was tried."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.choosing.models import HARMONICS
from ulna.calibration.choosing.tried import ChosenModel, TriedModel
from ulna.cli.printed.figures import WORDS
from ulna.cli.printed.tables import table
from ulna.ground.digits import figure_mm, fixed, uncertainty

COLUMNS: tuple[tuple[str, Callable[[TriedModel], str]], ...] = (
    ("param-\neters", lambda each: str(each.parameters)),
    ("prior\nu / rad", lambda each: f"{each.prior_u[HARMONICS]:.0e}" if HARMONICS in each.prior_u else "–"),
    ("left out\nmm", lambda each: figure_mm(each.error_mm)),
    ("worse\n%", lambda each: fixed(100.0 * each.worse_by, 1)),
    ("± u\n%", lambda each: fixed(100.0 * each.u_worse_by, 1)),
    ("", lambda each: "chosen" if each.kept else ""),
)
_FEW = 5
"""Rows where there is no room for all: geometry alone, what was chosen, and the best."""


def chosen_model(chosen: ChosenModel | None, all_of_it: bool) -> list[RenderableType]:
    """Nothing where nobody asked; some rows, or all of them."""
    if chosen is None:
        return []
    if not chosen.tried:
        return ["", Text("No model was chosen: too few readings to leave some out. Geometry alone was fitted.")]
    rows = list(chosen.tried) if all_of_it else _some(chosen.tried)
    made = table(f"Models tried: {WORDS[chosen.figure]}, left out", [""] + [head for head, _ in COLUMNS], _cells(rows))
    made.columns[len(COLUMNS)].justify = "left"
    model = model_in_words(chosen.extras, chosen.harmonics[-1] if chosen.harmonics else None, chosen.drawn)
    model = "geometry with its drawing" if model == "drawing" else model
    text = (
        f"Chosen: {model}, the most blocks that cannot be told from the best of {len(chosen.tried)} models (one "
        f"standard error), without each of {chosen.groups} groups ({chosen.by}); {chosen.seconds:.1f} s."
    )
    if chosen.ended == "budget":
        text += f" The budget ended the search: {chosen.untried} larger models were not tried."
    parts: list[RenderableType] = ["", made]
    if len(rows) < len(chosen.tried):
        parts.append(Text(f"… and {len(chosen.tried) - len(rows)} more: --all shows them."))
    parts.append(Text(text))
    if all_of_it:
        parts += [Text(f" {block} was not tried: {why}") for block, why in chosen.impossible.items()]
    return parts


def model_in_words(extras: Sequence[str], order: int | None, drawn: bool, lengths_u_mm: float | None = None) -> str:
    """Its blocks; what is known of lengths where that is said."""
    lengths = [] if lengths_u_mm is None else [f"lengths {uncertainty(lengths_u_mm)} mm"]
    if not drawn:
        return "geometry alone"
    names = [f"harmonics to {order}" if name == HARMONICS else name.removeprefix("link-") for name in extras]
    return ", ".join([*(names or ["drawing"]), *lengths])


def _cells(rows: Sequence[TriedModel]) -> list[list[str]]:
    """Of models without harmonics it is said how lengths are known: those with take the better."""
    return [
        [
            model_in_words(each.extras, each.order, each.drawn, None if each.order else each.lengths_u_mm),
            *(cell(each) for _, cell in COLUMNS),
        ]
        for each in rows
    ]


def _some(tried: Sequence[TriedModel]) -> list[TriedModel]:
    best = sorted(range(len(tried)), key=lambda k: (not tried[k].kept, k > 0, tried[k].error_mm))[:_FEW]
    return [tried[k] for k in sorted(best)]
