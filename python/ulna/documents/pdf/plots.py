"""Plots of residuals on paper: their distribution, and over what may cause them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ulna.documents.content.clouds import Cloud
from ulna.documents.content.distribution import Sample
from ulna.documents.content.readings import ReadingRows
from ulna.documents.content.thinning import shown, shown_ranks
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.pdf.canvas import HALF_MM, axes_of, labels, svg_of
from ulna.ground.style import BLUE, VERMILION

MOST_POINTS = 600
"""Of one cloud; besides them all outliers."""
MOST_RANKS = 600
TAILS = 50


def histogram(sample: Sample, words: Words) -> str:
    """Bars and the normal curve of the sample's mean and standard deviation."""
    say = labels(words)
    figure, axes = axes_of(HALF_MM, 50.0)
    edges, width = sample.edges_mm, np.diff(sample.edges_mm)
    axes.bar(edges[:-1], sample.counts, width, align="edge", color=BLUE, edgecolor="white", linewidth=0.4)
    if sample.sigma_mm > 0.0:
        x = np.linspace(edges[0], edges[-1], 201)
        z = (x - sample.mean_mm) / sample.sigma_mm
        normal = np.exp(-0.5 * z**2) / (sample.sigma_mm * math.sqrt(2.0 * math.pi)) * width[0] * len(sample.value_mm)
        axes.plot(x, normal, color="black", linestyle="--", label=say("legend.normal"))
        axes.legend(loc="upper right", fontsize=6.5)
        axes.set_ylim(0, 1.25 * max(float(normal.max()), float(sample.counts.max())))
    axes.set_xlabel(say("axis.error-mm"))
    axes.set_ylabel(say("axis.count"))
    return svg_of(figure)


def quantiles(sample: Sample, words: Words) -> tuple[str, list[Text]]:
    """Normal Q–Q plot; the picture and what its caption must say of what is shown."""
    say, count = labels(words), len(sample.ordered_mm)
    figure, axes = axes_of(HALF_MM, 50.0)
    kept = shown_ranks(count, MOST_RANKS, TAILS)
    ends = sample.quantile[[0, -1]]
    axes.plot(
        sample.quantile[kept], sample.ordered_mm[kept], ".", color=BLUE, markersize=3, label=say("legend.readings")
    )
    axes.plot(ends, sample.mean_mm + sample.sigma_mm * ends, color="black", linestyle="--", label=say("legend.normal"))
    axes.legend(loc="upper left", fontsize=6.5)
    axes.set_xlabel(say("axis.normal-quantile"))
    axes.set_ylabel(say("axis.error-mm"))
    few = words("shown.quantiles", shown=len(kept), count=count, tails=TAILS)
    return svg_of(figure), [few] if len(kept) < count else []


def cloud(found: Cloud, readings: ReadingRows, words: Words) -> tuple[str, list[Text]]:
    """Readings, outliers and means over one cause; the picture and what its caption must say of what is shown."""
    say = labels(words)
    figure, axes = axes_of(HALF_MM, 47.0)
    outlier = readings.outlier[found.reading]
    part = shown(outlier, MOST_POINTS)
    plain = part.index[~outlier[part.index]]
    most = 1.15 * float(np.abs(found.residual_mm[~outlier]).max(initial=0.0))
    axes.plot(found.x[plain], found.residual_mm[plain], ".", color=BLUE, markersize=2.5, alpha=0.6, markeredgewidth=0)
    beyond = outlier & (np.abs(found.residual_mm) > most) if most > 0.0 else np.zeros(len(outlier), dtype=bool)
    near = outlier & ~beyond
    axes.plot(found.x[near], found.residual_mm[near], "x", color=VERMILION, markersize=4)
    for sign, marker in ((1.0, "^"), (-1.0, "v")):
        own = beyond & (sign * found.residual_mm > 0.0)
        axes.plot(found.x[own], np.full(int(own.sum()), sign * most), marker, color=VERMILION, markersize=4)
    if len(found.trend.x):
        axes.errorbar(
            found.trend.x,
            found.trend.mean_mm,
            2.0 * found.trend.u_mm,
            fmt="D",
            color="black",
            markersize=2.5,
            linewidth=0.8,
        )
    signed = found.over == "joint"
    if most > 0.0:
        axes.set_ylim(-1.08 * most if signed else 0.0, 1.08 * most)
    axes.set_xlabel(_cause(found, say))
    axes.set_ylabel(say("axis.along-joint-mm" if signed else "axis.size-mm"))
    said = [words.say(part.said)]
    if beyond.any():
        said.append(words("shown.beyond", beyond=int(beyond.sum())))
    return svg_of(figure), said


def _cause(found: Cloud, say: Callable[..., str]) -> str:
    titles = {
        "joint": say("axis.joint-deg", joint=found.joint),
        "reach": say("axis.reach-mm"),
        "temperature": say("axis.temperature-joint", joint=found.joint) if found.joint else say("axis.temperature"),
    }
    return titles[found.over]
