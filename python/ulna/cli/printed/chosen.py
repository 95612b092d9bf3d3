"""Which model was chosen, and what was tried."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.choosing.tried import ChosenModel, TriedModel
from ulna.cli.printed.figures import WORDS
from ulna.cli.printed.tables import table
from ulna.ground.digits import figure_mm, uncertainty

_FEW = 5
"""Rows where there is no room for all: geometry alone, what was chosen, and the best."""


def chosen_model(chosen: ChosenModel | None, all_of_it: bool) -> list[RenderableType]:
    """Nothing where nobody asked; some rows, or all of them."""
    if chosen is None:
        return []
    if not chosen.tried:
        return ["", Text("No model was chosen: too few readings to leave some out. Geometry alone was fitted.")]
    rows = list(chosen.tried) if all_of_it else _some(chosen.tried)
    heads = ("", "parameters", "prior u", "left out / mm", "worse by", "± u", "")
    cells = [
        (
            model_in_words(each.extras, each.order),
            str(each.parameters),
            "–" if each.prior_u_rad is None else f"{each.prior_u_rad:.1e}",
            figure_mm(each.error_mm),
            figure_mm(each.worse_by_mm),
            uncertainty(each.u_worse_by_mm),
            "chosen" if each.kept else "",
        )
        for each in rows
    ]
    made = table(f"Models tried: {WORDS[chosen.figure]}, left out", heads, cells)
    made.columns[6].justify = "left"
    text = (
        f"Chosen: {model_in_words(chosen.extras, chosen.harmonics[-1] if chosen.harmonics else None)}, the fewest "
        f"parameters within one standard error of the best of {len(chosen.tried)} models, without each of "
        f"{chosen.groups} groups ({chosen.by}); {chosen.seconds:.1f} s."
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


def model_in_words(extras: Sequence[str], order: int | None) -> str:
    """Its blocks."""
    if not extras:
        return "geometry alone"
    names = [f"harmonics to {order}" if name == "encoder-harmonics" else name for name in extras]
    return ", ".join(names)


def _some(tried: Sequence[TriedModel]) -> list[TriedModel]:
    best = sorted(range(len(tried)), key=lambda k: (not tried[k].kept, k > 0, tried[k].error_mm))[:_FEW]
    return [tried[k] for k in sorted(best)]
