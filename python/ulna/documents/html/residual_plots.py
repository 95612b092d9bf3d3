"""Plots of residuals: their distribution, and over what may cause them."""

from __future__ import annotations

import math

import numpy as np

from ulna.documents.content.clouds import Cloud
from ulna.documents.content.distribution import Sample
from ulna.documents.content.readings import ReadingRows
from ulna.documents.content.thinning import shown, shown_ranks
from ulna.documents.html.markup import label, labels
from ulna.documents.html.plots import INK, MAIN, OUTLIER, Plot, axis, layout, line, numbers, points
from ulna.documents.languages.text import joined, named, number
from ulna.documents.languages.words import Words
from ulna.ground.arrays import I64

MOST_POINTS = 1500
"""Of one cloud; besides them all outliers."""
TAILS = 100

_UNITS = {"joint": "°", "reach": "mm", "temperature": "°C"}


def histogram_plot(name: str, sample: Sample, words: Words) -> Plot:
    """Bars and the normal curve of the sample's mean and standard deviation."""
    say = labels(words)
    edges = sample.edges_mm
    width = np.diff(edges)
    data = [
        {
            "type": "bar",
            "name": say("legend.readings"),
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
        data.append(line(say("legend.normal"), x, normal, INK, "dash"))
    return Plot(name, data, layout(axis(say("axis.error-mm")), axis(say("axis.count"), tickformat="d"), True))


def quantile_plot(name: str, sample: Sample, words: Words) -> Plot:
    """Normal Q–Q plot."""
    say = labels(words)
    count = len(sample.ordered_mm)
    kept = shown_ranks(count, MOST_POINTS, TAILS)
    few = words("shown.quantiles", shown=len(kept), count=count, tails=TAILS) if len(kept) < count else ()
    ends = sample.quantile[[0, -1]]
    data = [
        points(say("legend.readings"), sample.quantile[kept], sample.ordered_mm[kept], MAIN),
        line(say("legend.normal"), ends, sample.mean_mm + sample.sigma_mm * ends, INK, "dash"),
    ]
    return Plot(name, data, layout(axis(say("axis.normal-quantile")), axis(say("axis.error-mm")), True), few)


def cloud_plot(name: str, cloud: Cloud, readings: ReadingRows, words: Words) -> Plot:
    """Readings, outliers and means. The axis is that of the readings; outliers beyond it stand at its edge."""
    say = labels(words)
    outlier = readings.outlier[cloud.reading]
    part = shown(outlier, MOST_POINTS)
    plain = part.index[~outlier[part.index]]
    titles = {
        "joint": say("axis.joint-mm" if cloud.slides else "axis.joint-deg", joint=cloud.joint),
        "reach": say("axis.reach-mm"),
        "temperature": say("axis.temperature-joint", joint=cloud.joint) if cloud.joint else say("axis.temperature"),
    }
    signed = cloud.over == "joint"
    most = 1.15 * float(np.abs(cloud.residual_mm[~outlier]).max(initial=0.0))
    beyond = outlier & (np.abs(cloud.residual_mm) > most) if most > 0.0 else np.zeros(len(outlier), dtype=bool)
    data = [_marks(say("legend.readings"), cloud, plain, readings, MAIN, "circle", 5, words)]
    for kept, symbol, edge in (
        (outlier & ~beyond, "x", None),
        (beyond & (cloud.residual_mm > 0.0), "triangle-up", most),
        (beyond & (cloud.residual_mm < 0.0), "triangle-down", -most),
    ):
        if kept.any():
            far = np.flatnonzero(kept)
            data.append(_marks(say("legend.outliers"), cloud, far, readings, OUTLIER, symbol, 9, words, edge))
    if len(cloud.trend.x):
        data.append(
            points(
                say("legend.mean"),
                cloud.trend.x,
                cloud.trend.mean_mm,
                INK,
                "diamond",
                7,
                error_y={"type": "data", "array": numbers(2.0 * cloud.trend.u_mm), "color": INK, "thickness": 1.5},
            )
        )
    y = axis(say("axis.along-joint-mm" if signed else "axis.size-mm"))
    if most > 0.0:
        y["range"] = numbers([-1.08 * most if signed else 0.0, 1.08 * most])
    caption = words.say(part.said)
    if beyond.any():
        caption = joined([caption, words("shown.beyond", beyond=int(beyond.sum()))], " ")
    return Plot(name, data, layout(axis(titles[cloud.over], zeroline=False), y), caption, 300)


def _marks(
    title: str,
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
    row, unit = label(words("hover.row")), "mm" if cloud.slides else _UNITS[cloud.over]
    hover = [
        f"{where(readings, int(k), row)}<br>{number(float(x))} {unit}, {number(float(each))} mm"
        for k, x, each in zip(cloud.reading[kept], cloud.x[kept], value, strict=True)
    ]
    height = value if edge is None else np.full(len(kept), edge)
    return points(title, cloud.x[kept], height, colour, symbol, size, text=hover, hoverinfo="text")


def where(readings: ReadingRows, k: int, row: str) -> str:
    """Where to find a reading, for a plot; row: the word for it."""
    names = " · ".join(label(named(each)) for each in (readings.file[k], readings.artefact[k], readings.placement[k]))
    return f"{row} {int(readings.row[k])} · {names}"
