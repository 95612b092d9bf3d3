"""The picture of a volume map, as SVG and PNG."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ulna.ground.style import BLUE, GREY, STYLE, VERMILION, save_picture
from ulna.uncertainties.volume import Somewhere, VolumeMap
from ulna.uncertainties.zones import CELLS, by_length, cells

COLOURS = "cividis"
"""Made for readers who tell colours apart less well."""


def draw_volume(found: VolumeMap, folder: Path) -> None:
    """`volume`: points and lengths over the half plane through the base's axis, and lengths by length."""
    middle = list(found.lengths)[len(found.lengths) // 2]
    with rc_context(STYLE):
        figure = Figure(figsize=(10.2, 4.2), layout="constrained")
        points, lengths, curve = figure.subplots(1, 3)
        _half_plane(figure, points, found, found.points, "point_u_mm", "u of a point's position / µm")
        _half_plane(
            figure, lengths, found, found.lengths[middle], f"length_{middle:g}_U_mm", f"U of {middle:g} mm / µm"
        )
        lengths.set_ylabel("")
        points.set_title("points")
        lengths.set_title(f"lengths of {middle:g} mm")
        _by_length(curve, found)
        save_picture(figure, folder, "volume")


def _half_plane(figure: Figure, axes: Axes, found: VolumeMap, places: Somewhere, column: str, label: str) -> None:
    side = found.reach_mm / CELLS
    table = cells(found)
    r, z = (np.floor(table[name].to_numpy() / side).astype(np.int64) for name in ("r_mm", "z_mm"))
    grid = np.full((int(z.max() - z.min()) + 1, int(r.max()) + 1), np.nan)
    grid[z - z.min(), r] = 1000.0 * table[column].cast(float).fill_null(float("nan")).to_numpy()
    edges_r = side * np.arange(grid.shape[1] + 1)
    edges_z = side * (np.arange(grid.shape[0] + 1) + z.min())
    axes.plot(0, 0, color=VERMILION, marker="s", markersize=8, linestyle="", clip_on=False, zorder=3)
    axes.set_aspect("equal")
    axes.set_xlabel("distance from the base's axis / mm")
    axes.set_ylabel("height above the base / mm")
    if np.isnan(grid).all():
        axes.text(0.5, 0.5, "not determined", transform=axes.transAxes, ha="center", color=GREY)
        axes.set_xlim(0, edges_r[-1])
        axes.set_ylim(edges_z[0], edges_z[-1])
        return
    mesh = axes.pcolormesh(edges_r, edges_z, grid, cmap=COLOURS, rasterized=True)
    figure.colorbar(mesh, ax=axes, label=label, location="bottom", shrink=0.9)


def _by_length(axes: Axes, found: VolumeMap) -> None:
    rows = [(length, spread) for length, _, spread in by_length(found) if spread.median_mm is not None]
    axes.set_xlabel("length / mm")
    axes.set_ylabel("U of a length / µm")
    axes.set_title(f"lengths, p = {100 * found.p:g} %")
    if not rows:
        axes.text(0.5, 0.5, "not determined", transform=axes.transAxes, ha="center", color=GREY)
        return
    at = [length for length, _ in rows]

    def line(name: str, **style: Any) -> None:
        axes.plot(at, [1000.0 * getattr(spread, name) for _, spread in rows], **style)

    line("largest_mm", color=GREY, marker="^", linestyle=":", label="largest")
    line("most_mm", color=VERMILION, marker="s", linestyle="--", label="95 % of places have less")
    line("median_mm", color=BLUE, marker="o", label="median")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.legend(loc="lower right")
