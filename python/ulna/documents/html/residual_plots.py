"""Figures of residuals: distribution, over causes, reading by reading, in space."""

from __future__ import annotations

import html
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ulna.documents.content import Cloud, Content, Quiver, ReadingRows, Sample
from ulna.documents.html.markup import END, ISOLATE, number
from ulna.documents.html.plots import INK, MAIN, OUTLIER, SECOND, Plot, axis, layout, line, numbers, points
from ulna.documents.languages.words import Words
from ulna.documents.thinning import runs, shown, shown_ranks

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

MOST_POINTS = 1500
"""Of one cloud; besides them all outliers."""
MOST_BARS = 600
MOST_VECTORS = 1500
TAILS = 100
ARROW = 0.08
"""Of the extent of all tips: how long the longest but a twentieth of the vectors are drawn."""

_UNITS = {"joint": "°", "reach": "mm", "temperature": "°C"}


def distribution_plots(samples: Sequence[Sample], page: Words, words: Words) -> list[Plot]:
    """Histogram and Q–Q plot of each sample."""
    found = []
    for k, sample in enumerate(samples):
        said = {"artefact": sample.artefact, "kind": words(f"sample.{sample.kind}"), "count": len(sample.value_mm)}
        figures = {"mean": sample.mean_mm, "sigma": sample.sigma_mm}
        found.append(_histogram(f"histogram-{k}", sample, page("distribution.histogram", **said, **figures), words))
        found.append(_quantiles(f"quantiles-{k}", sample, page("distribution.qq", **_but(said)), page, words))
    return found


def _but(said: dict[str, object]) -> dict[str, object]:
    return {name: value for name, value in said.items() if name != "count"}


def _histogram(name: str, sample: Sample, caption: str, words: Words) -> Plot:
    edges = sample.edges_mm
    width = np.diff(edges)
    data = [
        {
            "type": "bar",
            "name": words("legend.readings"),
            "x": numbers(0.5 * (edges[1:] + edges[:-1])),
            "y": sample.counts.tolist(),
            "width": numbers(width),
            "marker": {"color": MAIN, "line": {"color": "@paper", "width": 1}},
        }
    ]
    if sample.sigma_mm > 0.0:
        x = np.linspace(edges[0], edges[-1], 121)
        z = (x - sample.mean_mm) / sample.sigma_mm
        density = np.exp(-0.5 * z**2) / (sample.sigma_mm * math.sqrt(2.0 * math.pi))
        normal = density * width[0] * len(sample.value_mm)
        data.append(line(words("legend.normal"), x, normal, INK, "dash"))
    return Plot(
        name, caption, data, layout(axis(words("axis.error-mm")), axis(words("axis.count"), tickformat="d"), True)
    )


def _quantiles(name: str, sample: Sample, caption: str, page: Words, words: Words) -> Plot:
    count = len(sample.ordered_mm)
    kept = shown_ranks(count, MOST_POINTS, TAILS)
    if len(kept) < count:
        caption += " " + page("shown.quantiles", shown=len(kept), count=count, tails=TAILS)
    ends = sample.quantile[[0, -1]]
    data = [
        points(words("legend.readings"), sample.quantile[kept], sample.ordered_mm[kept], MAIN),
        line(words("legend.normal"), ends, sample.mean_mm + sample.sigma_mm * ends, INK, "dash"),
    ]
    return Plot(name, caption, data, layout(axis(words("axis.normal-quantile")), axis(words("axis.error-mm")), True))


def cloud_plot(cloud: Cloud, readings: ReadingRows, page: Words, words: Words) -> Plot:
    """Readings, outliers and means. The axis is that of the readings; outliers beyond it stand at its edge."""
    outlier = readings.outlier[cloud.reading]
    part = shown(outlier, MOST_POINTS)
    plain = part.index[~outlier[part.index]]
    titles = {
        "joint": words("axis.joint-deg", joint=cloud.joint),
        "reach": words("axis.reach-mm"),
        "temperature": words("axis.temperature-joint", joint=cloud.joint) if cloud.joint else words("axis.temperature"),
    }
    signed = cloud.over == "joint"
    most = 1.15 * float(np.abs(cloud.residual_mm[~outlier]).max(initial=0.0))
    beyond = outlier & (np.abs(cloud.residual_mm) > most) if most > 0.0 else np.zeros(len(outlier), dtype=bool)
    data = [_marks(words("legend.readings"), cloud, plain, readings, MAIN, "circle", 5, words)]
    for kept, symbol, edge in (
        (outlier & ~beyond, "x", None),
        (beyond & (cloud.residual_mm > 0.0), "triangle-up", most),
        (beyond & (cloud.residual_mm < 0.0), "triangle-down", -most),
    ):
        if kept.any():
            far = np.flatnonzero(kept)
            data.append(_marks(words("legend.outliers"), cloud, far, readings, OUTLIER, symbol, 9, words, edge))
    if len(cloud.trend.x):
        data.append(
            points(
                words("legend.mean"),
                cloud.trend.x,
                cloud.trend.mean_mm,
                INK,
                "diamond",
                7,
                error_y={"type": "data", "array": numbers(2.0 * cloud.trend.u_mm), "color": INK, "thickness": 1.5},
            )
        )
    y = axis(words("axis.along-joint-mm" if signed else "axis.size-mm"))
    if most > 0.0:
        y["range"] = numbers([-1.08 * most if signed else 0.0, 1.08 * most])
    caption: str = page.say(part.said)
    if beyond.any():
        caption += f" {page('shown.beyond', beyond=int(beyond.sum()))}"
    return Plot(f"{cloud.over}-{cloud.joint}", caption, data, layout(axis(titles[cloud.over], zeroline=False), y), 300)


def _marks(
    label: str,
    cloud: Cloud,
    kept: I64,
    readings: ReadingRows,
    colour: str,
    symbol: str,
    size: float,
    words: Words,
    edge: float | None = None,
) -> dict[str, object]:
    """edge: where they stand, their own values being beyond the axis."""
    value = cloud.residual_mm[kept]
    hover = [
        f"{reading_label(readings, int(k), words)}<br>{number(float(x))} {_UNITS[cloud.over]}, {number(float(each))} mm"
        for k, x, each in zip(cloud.reading[kept], cloud.x[kept], value, strict=True)
    ]
    height = value if edge is None else np.full(len(kept), edge)
    return points(label, cloud.x[kept], height, colour, symbol, size, text=hover, hoverinfo="text")


def reading_label(readings: ReadingRows, k: int, words: Words) -> str:
    """Where to find a reading, for a figure."""
    names = " · ".join(
        f"{ISOLATE}{html.escape(each, quote=False)}{END}"
        for each in (readings.file[k], readings.artefact[k], readings.placement[k])
    )
    return f"{words('hover.row')} {int(readings.row[k])} · {names}"


def pose_plot(readings: ReadingRows, page: Words, words: Words) -> Plot:
    """Bars of the residuals' sizes, in the order of the study; of very many, runs of readings."""
    found = runs(readings.size_mm, readings.outlier, MOST_BARS)
    x = found.first + 1 + 0.5 * (found.step - 1)
    one = found.step == 1
    count = len(readings.size_mm)
    said = page("shown.bars", count=count) if one else page("shown.runs", step=found.step, count=count)
    labels = [reading_label(readings, int(k), words) for k in found.first]
    colour = [OUTLIER if far else MAIN for far in found.outlier]

    def bars(label: str, height: F64, colour: str | list[str]) -> dict[str, object]:
        return {
            "type": "bar",
            "name": label,
            "x": numbers(x),
            "y": numbers(height),
            "text": labels,
            "textposition": "none",
            "hoverinfo": "text+y",
            "marker": {"color": colour, "line": {"width": 0}},
        }

    data = [bars(words("legend.max"), found.largest, "@faint")] if not one else []
    data.append(
        bars(
            words("legend.readings" if one else "legend.rms"),
            found.rms,
            MAIN if one and not found.outlier.any() else colour,
        )
    )
    if found.outlier.any():
        data.append(points(words("legend.outliers"), x[found.outlier], found.largest[found.outlier], OUTLIER, "x", 9))
    shape = layout(
        axis(words("axis.reading"), zeroline=False, tickformat="d"),
        axis(words("axis.size-mm")),
        True,
        barmode="overlay",
        bargap=0.1,
    )
    return Plot("poses", said, data, shape, 340)


def space_plot(quiver: Quiver, content: Content, page: Words, words: Words) -> Plot:
    """Residual vectors at the tips."""
    outlier = content.readings.outlier[quiver.reading]
    part = shown(outlier, MOST_VECTORS)
    factor = arrow_factor(quiver)
    data = []
    for kept, label, colour in (
        (part.index[~outlier[part.index]], "legend.vectors", MAIN),
        (np.flatnonzero(outlier), "legend.outliers", OUTLIER),
    ):
        if len(kept):
            data += _arrows(words(label), quiver, kept, factor, colour)
    data.append(
        {
            "type": "scatter3d",
            "mode": "markers",
            "name": words("legend.base"),
            "x": [0],
            "y": [0],
            "z": [0],
            "marker": {"symbol": "square", "size": 6, "color": SECOND},
        }
    )
    axes = {
        f"{each}axis": {
            "title": {"text": words(f"axis.{each}-mm")},
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
    caption = f"{page('space.note', factor=int(factor) if factor >= 1.0 else factor)} {page.say(part.said)}"
    return Plot("space", caption, data, shape, 560, solid=True)


def _arrows(label: str, quiver: Quiver, kept: I64, factor: float, colour: str) -> list[dict[str, object]]:
    at = quiver.at_mm[kept]
    end = at + factor * quiver.vector_mm[kept]
    lines = np.full((len(kept), 3, 3), np.nan)  # each arrow, then a gap
    lines[:, 0], lines[:, 1] = at, end
    shaft: dict[str, object] = {
        "type": "scatter3d",
        "mode": "lines",
        "name": label,
        "hoverinfo": "skip",
        "line": {"color": colour, "width": 3},
    }
    foot: dict[str, object] = {
        "type": "scatter3d",
        "mode": "markers",
        "name": label,
        "showlegend": False,
        "marker": {"color": colour, "size": 2.5},
    }
    for k, each in enumerate("xyz"):
        shaft[each] = numbers(lines[:, :, k])
        foot[each] = numbers(at[:, k])
    return [shaft, foot]


def arrow_factor(quiver: Quiver) -> float:
    """By how much vectors are drawn longer than they are: 1, 2 or 5 times a power of ten."""
    size = float(np.quantile(np.linalg.norm(quiver.vector_mm, axis=1), 0.95))
    extent = float(np.linalg.norm(np.ptp(quiver.at_mm, axis=0)))
    if not size > 0.0 or not extent > 0.0:
        return 1.0
    wanted = ARROW * extent / size
    power = 10.0 ** math.floor(math.log10(wanted))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= wanted))
