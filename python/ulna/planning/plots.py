"""The pictures of a plan, as SVG and PNG."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from ulna.ground.arrays import F64
from ulna.ground.style import BLUE, GREY, STYLE, VERMILION, save_picture


def draw_places(places_mm: F64, folder: Path) -> None:
    """`places`: where the artefact's features stand, (S, K, 3), seen from above and from the side; base at 0."""
    with rc_context(STYLE):
        figure = Figure(figsize=(7.2, 3.9), layout="constrained")
        for axes, (across, up), title in zip(
            figure.subplots(1, 2), ((0, 1), (0, 2)), ("from above", "from the side"), strict=True
        ):
            for points in places_mm:
                axes.plot(points[:, across], points[:, up], color=BLUE, linewidth=0.9, alpha=0.6)
                axes.plot(points[:, across], points[:, up], color=BLUE, linestyle="", marker="o", markersize=2.5)
            axes.plot(0, 0, color=VERMILION, marker="s", markersize=7, linestyle="")
            axes.annotate("base", (0, 0), xytext=(6, 6), textcoords="offset points", color=VERMILION, fontsize=9)
            axes.set_aspect("equal", adjustable="datalim")
            axes.set_title(title)
            axes.set_xlabel(f"{'xyz'[across]} / mm")
            axes.set_ylabel(f"{'xyz'[up]} / mm")
        save_picture(figure, folder, "places")


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
