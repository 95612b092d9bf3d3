"""The pictures of a plan, as SVG and PNG."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib import patheffects, rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ulna.ground.arrays import F64
from ulna.ground.style import BLUE, GREY, STYLE, VERMILION, save_picture
from ulna.planning.stands import Stand

TOGETHER = 12
"""Stands in a row of pictures, so that each number can be read; the others are grey."""
VIEWS = (((0, 1), "from above"), ((0, 2), "from the side"))


def draw_places(stands: list[Stand], folder: Path) -> None:
    """`places`: where the artefact stands, each with its number, seen from above and from the side; base at 0."""
    groups = rows_of(stands)
    with rc_context(STYLE):
        figure = Figure(figsize=(9.0, 4.3 * len(groups)), layout="constrained")
        rows = figure.subplots(len(groups), 2, squeeze=False)
        for row, group in zip(rows, groups, strict=True):
            for axes, (seen, title) in zip(row, VIEWS, strict=True):
                draw_stands(axes, stands, group, seen)
                one = len(group) == 1
                of = f"stand {group[0].number}" if one else f"stands {group[0].number} to {group[-1].number}"
                axes.set_title(f"{of}, {title}")
        save_picture(figure, folder, "places")


def rows_of(stands: list[Stand]) -> list[list[Stand]]:
    """In groups of nearly the same size, of TOGETHER at the most."""
    parts = np.array_split(np.arange(len(stands)), -(-len(stands) // TOGETHER))
    return [[stands[k] for k in part.tolist()] for part in parts]


def draw_stands(
    axes: Axes, stands: Sequence[Stand], shown: Sequence[Stand], seen: tuple[int, int], base: str = "base"
) -> None:
    """Some of the stands with their numbers, the others grey; seen: the coordinates across and up; base: its name."""
    own = {stand.number for stand in shown}
    pick = list(seen)
    lines = [(stand.number, stand.points_mm[:, pick]) for stand in stands]
    for number, points in sorted(lines, key=lambda each: each[0] in own):
        lit = number in own
        axes.plot(*points.T, color=BLUE if lit else "0.85", linewidth=1.4 if lit else 0.7, zorder=3 if lit else 1)
        style = {"marker": "o", "markersize": 3.5 if lit else 2.0, "linestyle": ""}
        axes.plot(*points.T, color=BLUE if lit else "0.85", zorder=3 if lit else 1, **style)  # type: ignore[arg-type]
    axes.plot(0, 0, color=VERMILION, marker="s", markersize=8, linestyle="", zorder=4)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.1)
    every = np.concatenate([points for _, points in lines] + [np.zeros((1, 2))])
    size = float(np.ptp(every, axis=0).max())
    halo = [patheffects.withStroke(linewidth=2.5, foreground="white")]
    labels = places_of_numbers([points for number, points in lines if number in own], size)
    for stand, (x, y) in zip(shown, labels, strict=True):
        axes.text(
            x, y, str(stand.number), ha="center", va="center", fontsize=9, fontweight="bold",
            fontfamily="DejaVu Sans", color="black", zorder=6, path_effects=halo,
        )  # fmt: skip
    axes.annotate(
        base, (0, 0), xytext=(0, -13), textcoords="offset points", color=VERMILION, fontsize=9, ha="center", zorder=5,
        path_effects=halo,
    )  # fmt: skip
    axes.set_xlabel(f"{'xyz'[seen[0]]} / mm")
    axes.set_ylabel(f"{'xyz'[seen[1]]} / mm")


def places_of_numbers(points: list[F64], size: float) -> list[tuple[float, float]]:
    """Where numbers of (K, 2) points stand, in a picture of so many mm: beside an end or along the line, each as far as
    can be from those before it and from the others' lines."""
    sampled = [
        np.concatenate([a + np.linspace(0.0, 1.0, 9)[:, None] * (b - a) for a, b in _pieces(each)]) for each in points
    ]
    found: list[tuple[float, float]] = []
    for number, each in enumerate(points):
        first, last = each[0], each[-1]
        along = last - first
        length = float(np.linalg.norm(along))
        along = along / length if length > 1e-9 else np.array([1.0, 0.0])
        across = np.array([-along[1], along[0]])
        step = 0.035 * size
        spots = [first - step * along, last + step * along]
        middle = [first + share * (last - first) for share in (0.1, 0.3, 0.5, 0.7, 0.9)]
        spots += [at + side * step * across for at in middle for side in (1.0, -1.0)]
        taken = np.array(found).reshape(-1, 2)
        others = np.concatenate([np.zeros((1, 2)), *(sampled[:number] + sampled[number + 1 :])])

        def room(spot: F64, taken: F64 = taken, others: F64 = others) -> float:
            to_numbers = np.linalg.norm(taken - spot, axis=1).min(initial=size) / (0.07 * size)
            to_others = np.linalg.norm(others - spot, axis=1).min() / (0.07 * size)
            return float(min(to_numbers, 1.0) + min(to_others, 1.0))

        x, y = max(spots, key=room).tolist()
        found.append((x, y))
    return found


def _pieces(points: F64) -> list[tuple[F64, F64]]:
    """From point to point; of a single one from it to itself."""
    return list(pairwise(points)) or [(points[0], points[0])]


def draw_curve(curve: list[tuple[int, float, float]], paper: tuple[int, float] | None, folder: Path) -> None:
    """`curve`: how the expected length uncertainty (mm, planned and random) falls with the number of measurements;
    paper: a number of random measurements, and what they reach."""
    counts, own, by_chance = (np.array(values) for values in zip(*curve, strict=True))
    with rc_context(STYLE):
        figure = Figure(figsize=(6.4, 3.8), layout="constrained")
        axes = figure.subplots()
        axes.plot(counts, 1000 * by_chance, color=VERMILION, marker="s", label="random")
        axes.plot(counts, 1000 * own, color=BLUE, marker="o", label="planned")
        if paper is not None:
            label = f"{paper[0]} random"
            axes.axhline(1000 * paper[1], color=GREY, linestyle="--", linewidth=1, label=label)
        axes.set_xlabel("measurements")
        axes.set_ylabel("expected length uncertainty / µm")
        axes.set_yscale("log")
        ticks = (1, 2, 3, 5, 10, 20, 30, 50, 100, 200, 500, 1000)
        low, high = 800 * own.min(), 1300 * by_chance.max()
        axes.set_ylim(low, high)
        axes.set_yticks([tick for tick in ticks if low <= tick <= high], minor=False)
        axes.set_yticklabels([f"{tick}" for tick in ticks if low <= tick <= high])
        axes.minorticks_off()
        axes.legend()
        save_picture(figure, folder, "curve")
