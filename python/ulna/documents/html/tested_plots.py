"""Length errors of an acceptance test over the length."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ulna.documents.content.acceptance import TestedLengths, limit_lines
from ulna.documents.html.markup import labels
from ulna.documents.html.plots import GOOD, INK, OUTLIER, UNDECIDED, Plot, axis, layout, line, points
from ulna.documents.languages.words import Words

#: verdict → colour and shape of its marks
MARKS = {
    "pass": (GOOD, "circle"),
    "undecided": (UNDECIDED, "diamond"),
    "fail": (OUTLIER, "x"),
    None: (INK, "circle-open"),
}


def tested_lengths_plot(name: str, found: TestedLengths, words: Words) -> Plot:
    """Length errors of a test over the length, with ±MPE and the guard bands about them."""
    say = labels(words)
    data = _limits(found, say)
    for verdict, (colour, symbol) in MARKS.items():
        own = np.array([each == verdict for each in found.verdict], dtype=bool)
        if own.any():
            title = say(f"conformity.{verdict or 'none'}")
            data.append(points(title, found.length_mm[own], found.error_mm[own], colour, symbol, 7))
    shape = layout(axis(say("axis.length-mm"), zeroline=False), axis(say("axis.length-error-mm")), True)
    return Plot(name, data, shape, height_px=380)


def _limits(found: TestedLengths, say: Callable[..., str]) -> list[dict[str, object]]:
    lines = limit_lines(found)
    if lines is None:
        return []
    x, limit, guard = lines
    data: list[dict[str, object]] = []
    for side in (1.0, -1.0):
        shown = {"showlegend": side > 0.0}
        if guard.any():
            outline = np.concatenate([limit + guard, (limit - guard)[::-1]])
            band = line(say("legend.guard"), np.concatenate([x, x[::-1]]), side * outline, "@band", "solid", **shown)
            data.append({**band, "fill": "toself", "fillcolor": "@band", "hoverinfo": "skip"})
        data.append(line(say("legend.mpe"), x, side * limit, INK, "dash", **shown))
    return data
