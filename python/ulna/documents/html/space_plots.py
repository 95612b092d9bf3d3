"""Plots of the readings themselves: the size of each residual, and residuals as vectors in space."""

from __future__ import annotations

import numpy as np

from ulna.documents.content.clouds import Quiver
from ulna.documents.content.readings import ReadingRows
from ulna.documents.content.thinning import runs, shown
from ulna.documents.html.markup import label, labels
from ulna.documents.html.plots import INK, MAIN, OUTLIER, Plot, axis, layout, numbers, points
from ulna.documents.html.residual_plots import where
from ulna.documents.languages.text import joined
from ulna.documents.languages.words import Words
from ulna.ground.arrays import F64, I64

MOST_BARS = 600
MOST_VECTORS = 1500


def pose_plot(name: str, readings: ReadingRows, words: Words) -> Plot:
    """Bars of the residuals' sizes, in the order of the study; of very many, runs of readings."""
    say, row = labels(words), label(words("hover.row"))
    found = runs(readings.size_mm, readings.outlier, MOST_BARS)
    x = found.first + 1 + 0.5 * (found.step - 1)
    one = found.step == 1
    count = len(readings.size_mm)
    said = words("shown.bars", count=count) if one else words("shown.runs", step=found.step, count=count)
    hover = [where(readings, int(k), row) for k in found.first]
    colour = [OUTLIER if far else MAIN for far in found.outlier]

    def bars(title: str, height: F64, colour: str | list[str]) -> dict[str, object]:
        return {
            "type": "bar",
            "name": title,
            "x": numbers(x),
            "y": numbers(height),
            "text": hover,
            "textposition": "none",
            "hoverinfo": "text+y",
            "marker": {"color": colour, "line": {"width": 0}},
        }

    data = [bars(say("legend.max"), found.largest, "@faint")] if not one else []
    data.append(
        bars(
            say("legend.readings" if one else "legend.rms"),
            found.rms,
            MAIN if one and not found.outlier.any() else colour,
        )
    )
    if found.outlier.any():
        data.append(points(say("legend.outliers"), x[found.outlier], found.largest[found.outlier], OUTLIER, "x", 9))
    shape = layout(
        axis(say("axis.reading"), zeroline=False, tickformat="d"),
        axis(say("axis.size-mm")),
        True,
        barmode="overlay",
        bargap=0.1,
    )
    return Plot(name, data, shape, said)


def space_plot(name: str, quiver: Quiver, readings: ReadingRows, words: Words) -> Plot:
    """Residual vectors at the tips."""
    say = labels(words)
    outlier = readings.outlier[quiver.reading]
    part = shown(outlier, MOST_VECTORS)
    factor = quiver.arrow_factor
    data = []
    for kept, key, colour in (
        (part.index[~outlier[part.index]], "legend.vectors", MAIN),
        (np.flatnonzero(outlier), "legend.outliers", OUTLIER),
    ):
        if len(kept):
            data += _arrows(say(key), quiver, kept, factor, colour)
    data.append(
        {
            "type": "scatter3d",
            "mode": "markers",
            "name": say("legend.base"),
            "x": [0],
            "y": [0],
            "z": [0],
            "marker": {"symbol": "square", "size": 6, "color": INK},
        }
    )
    axes = {
        f"{each}axis": {
            "title": {"text": say(f"axis.{each}-mm")},
            "gridcolor": "@grid",
            "zerolinecolor": "@axis",
            "color": INK,
            "showbackground": False,
            "nticks": 6,
        }
        for each in "xyz"
    }
    shape = {
        "scene": {
            **axes,
            "aspectmode": "data",
            "camera": {"eye": {"x": 1.4, "y": 1.4, "z": 0.85}, "center": {"x": 0, "y": 0, "z": -0.15}},
        },
        "margin": {"l": 0, "r": 0, "t": 30, "b": 0},
        "showlegend": True,
        "legend": {"orientation": "h", "x": 0, "y": 1.0, "yanchor": "bottom"},
    }
    note = words("space.note", factor=int(factor) if factor >= 1.0 else factor)
    return Plot(name, data, shape, joined([note, words.say(part.said)], " "), 560, solid=True)


def _arrows(title: str, quiver: Quiver, kept: I64, factor: float, colour: str) -> list[dict[str, object]]:
    at = quiver.at_mm[kept]
    end = at + factor * quiver.vector_mm[kept]
    lines = np.full((len(kept), 3, 3), np.nan)  # each arrow, then a gap
    lines[:, 0], lines[:, 1] = at, end
    shaft: dict[str, object] = {
        "type": "scatter3d",
        "mode": "lines",
        "name": title,
        "hoverinfo": "skip",
        "line": {"color": colour, "width": 3},
    }
    foot: dict[str, object] = {
        "type": "scatter3d",
        "mode": "markers",
        "name": title,
        "showlegend": False,
        "marker": {"color": colour, "size": 2.5},
    }
    for k, each in enumerate("xyz"):
        shaft[each] = numbers(lines[:, :, k])
        foot[each] = numbers(at[:, k])
    return [shaft, foot]
