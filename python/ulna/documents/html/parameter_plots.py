"""Plots of parameters and lengths: correlation map, singular values, length errors."""

from __future__ import annotations

import math

import numpy as np

from ulna.documents.content.parameters import Observability, Parameters
from ulna.documents.content.readings import Lengths
from ulna.documents.content.thinning import shown
from ulna.documents.html.markup import label, labels
from ulna.documents.html.plots import INK, MAIN, OUTLIER, Plot, axis, layout, numbers, points
from ulna.documents.languages.text import named
from ulna.documents.languages.words import Words

MOST_LENGTHS = 3000

#: blue, the paper, vermilion: told apart by all, and by a printer without colours from the middle
DIVERGING = [[0, "#0072B2"], [0.5, "@paper"], [1, "#D55E00"]]


def correlation_plot(name: str, parameters: Parameters, _: Words) -> Plot:
    """The matrix as colours."""
    names = [label(named(each)) for each in parameters.correlation_names]
    matrix = parameters.correlation
    data = [
        {
            "type": "heatmap",
            "x": names,
            "y": names,
            "z": [[None if value is None else round(value, 4) for value in numbers(row)] for row in matrix],
            "zmin": -1,
            "zmax": 1,
            "colorscale": DIVERGING,
            "xgap": 1,
            "ygap": 1,
            "colorbar": {"title": {"text": "r"}, "thickness": 12, "tickcolor": INK, "outlinewidth": 0},
            "hovertemplate": "%{y}<br>%{x}<br>r = %{z}<extra></extra>",
        }
    ]
    small = {"size": 10}
    ticks = {"tickfont": small, "showgrid": False, "zeroline": False, "dtick": 1}
    shape = layout(
        axis("", tickangle=-90, **ticks),
        axis("", autorange="reversed", **ticks),
        margin={"l": 8, "r": 8, "t": 34, "b": 8},
    )
    return Plot(name, data, shape, height_px=200 + 15 * len(names))


def singular_plot(name: str, found: Observability, words: Words) -> Plot:
    """On a logarithmic axis; those not determined, rounding only, are open."""
    say = labels(words)
    values = found.singular_values
    number = np.arange(1, len(values) + 1)
    kept = number <= found.determined
    data = [points(say("legend.determined"), number[kept], values[kept], MAIN, size=8)]
    lost = ~kept & (values > 0.0)
    if lost.any():
        data.append(points(say("legend.lost"), number[lost], values[lost], OUTLIER, "diamond-open", 9))
    seen = values[values > 0.0]
    decades = math.log10(float(seen[0] / seen[-1]))
    # ticks within decades where there are few of them, else some of the decades
    step: str | int = "D2" if decades < 2.2 else math.ceil(decades / 8)
    y = axis(say("axis.singular-value"), type="log", dtick=step)
    shape = layout(axis(say("axis.index"), zeroline=False), y, bool(lost.any()))
    return Plot(name, data, shape)


def length_plot(name: str, lengths: Lengths, words: Words) -> Plot:
    """Length errors of the fitted readings."""
    say = labels(words)
    part = shown(np.zeros(len(lengths.error_mm), dtype=bool), MOST_LENGTHS)
    data = [points(say("legend.readings"), lengths.length_mm[part.index], lengths.error_mm[part.index], MAIN)]
    x = axis(say("axis.length-mm"), zeroline=False)
    if float(np.ptp(lengths.length_mm)) == 0.0:  # one length: an axis that is not made of rounding
        middle = float(lengths.length_mm[0])
        x |= {"range": [0.9 * middle, 1.1 * middle]}
    caption = words.say(part.said) if part.step > 1 else ()
    return Plot(name, data, layout(x, axis(say("axis.length-error-mm"))), caption)
