"""Drawings of residuals on axes of Matplotlib: their distribution, over what may cause them, and in space.

Paper (`documents/pdf`) and notebooks (`Result.plot`) draw the same; each says what of very many readings is shown.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ulna.documents.content.clouds import Cloud, Quiver
from ulna.documents.content.distribution import Sample
from ulna.documents.content.readings import ReadingRows
from ulna.documents.content.thinning import Shown, shown, shown_ranks
from ulna.ground.style import BLUE, GREY, VERMILION

Say = Callable[..., str]
"""Key of the catalogue and values → words for axes and legends."""

MOST_POINTS = 600
"""Of one cloud; besides them all outliers."""
MOST_RANKS = 600
TAILS = 50
MOST_VECTORS = 1500


def histogram(axes: Axes, sample: Sample, say: Say, small: float = 6.5) -> None:
    """Bars and the normal curve of the sample's mean and standard deviation. small: size of a legend's letters."""
    edges, width = sample.edges_mm, np.diff(sample.edges_mm)
    axes.bar(edges[:-1], sample.counts, width, align="edge", color=BLUE, edgecolor="white", linewidth=0.4)
    if sample.sigma_mm > 0.0:
        x = np.linspace(edges[0], edges[-1], 201)
        z = (x - sample.mean_mm) / sample.sigma_mm
        normal = np.exp(-0.5 * z**2) / (sample.sigma_mm * math.sqrt(2.0 * math.pi)) * width[0] * len(sample.value_mm)
        axes.plot(x, normal, color="black", linestyle="--", label=say("legend.normal"))
        axes.legend(loc="upper right", fontsize=small)
        axes.set_ylim(0, 1.25 * max(float(normal.max()), float(sample.counts.max())))
    axes.set_xlabel(say("axis.error-mm"))
    axes.set_ylabel(say("axis.count"))


def quantiles(axes: Axes, sample: Sample, say: Say, small: float = 6.5) -> int:
    """Normal Q–Q plot; of how many errors points are shown."""
    kept = shown_ranks(len(sample.ordered_mm), MOST_RANKS, TAILS)
    ends = sample.quantile[[0, -1]]
    axes.plot(
        sample.quantile[kept], sample.ordered_mm[kept], ".", color=BLUE, markersize=3, label=say("legend.readings")
    )
    axes.plot(ends, sample.mean_mm + sample.sigma_mm * ends, color="black", linestyle="--", label=say("legend.normal"))
    axes.legend(loc="upper left", fontsize=small)
    axes.set_xlabel(say("axis.normal-quantile"))
    axes.set_ylabel(say("axis.error-mm"))
    return len(kept)


def cloud(axes: Axes, found: Cloud, readings: ReadingRows, say: Say, mark: float = 2.5) -> tuple[Shown, int]:
    """Readings, outliers and means over one cause; what is shown of them, and how many outliers are beyond the axis.
    mark: size of a reading's mark."""
    outlier = readings.outlier[found.reading]
    part = shown(outlier, MOST_POINTS)
    plain = part.index[~outlier[part.index]]
    most = 1.15 * float(np.abs(found.residual_mm[~outlier]).max(initial=0.0))
    point: dict[str, Any] = {"color": BLUE, "markersize": mark, "alpha": 0.6, "markeredgewidth": 0}
    axes.plot(found.x[plain], found.residual_mm[plain], ".", label=say("legend.readings"), **point)
    beyond = outlier & (np.abs(found.residual_mm) > most) if most > 0.0 else np.zeros(len(outlier), dtype=bool)
    near = outlier & ~beyond
    far = say("legend.outliers") if outlier.any() else None
    axes.plot(found.x[near], found.residual_mm[near], "x", color=VERMILION, markersize=4, label=far)
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
            label=say("legend.mean"),
        )
    signed = found.over == "joint"
    if most > 0.0:
        axes.set_ylim(-1.08 * most if signed else 0.0, 1.08 * most)
    axes.set_xlabel(_cause(found, say))
    axes.set_ylabel(say("axis.along-joint-mm" if signed else "axis.size-mm"))
    return part, int(beyond.sum())


def _cause(found: Cloud, say: Say) -> str:
    titles = {
        "joint": say("axis.joint-mm" if found.slides else "axis.joint-deg", joint=found.joint),
        "reach": say("axis.reach-mm"),
        "temperature": say("axis.temperature-joint", joint=found.joint) if found.joint else say("axis.temperature"),
    }
    return titles[found.over]


def arrows(axes: Axes, quiver: Quiver, readings: ReadingRows, say: Say, view: str = "xy", small: float = 6.5) -> float:
    """Residuals as arrows at the tips, seen along an axis of the base frame: view "xy" from above, "xz" or "yz" from a
    side. By how much they are drawn longer than they are."""
    across, up = ("xyz".index(letter) for letter in view)
    outlier = readings.outlier[quiver.reading]
    part = shown(outlier, MOST_VECTORS)
    factor = quiver.arrow_factor
    for kept, key, colour in (
        (part.index[~outlier[part.index]], "legend.vectors", BLUE),
        (np.flatnonzero(outlier), "legend.outliers", VERMILION),
    ):
        if len(kept):
            at, vector = quiver.at_mm[kept], factor * quiver.vector_mm[kept]
            axes.quiver(
                at[:, across],
                at[:, up],
                vector[:, across],
                vector[:, up],
                angles="xy",
                scale_units="xy",
                scale=1.0,
                width=0.0025,
                color=colour,
                label=say(key),
            )
            end = at + vector  # arrows alone do not widen the axes
            axes.update_datalim(np.concatenate([at[:, [across, up]], end[:, [across, up]]]))
    axes.plot(0.0, 0.0, "s", color=GREY, markersize=6, label=say("legend.base"))
    axes.autoscale_view()
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(say(f"axis.{view[0]}-mm"))
    axes.set_ylabel(say(f"axis.{view[1]}-mm"))
    axes.legend(loc="best", fontsize=small)
    return factor
