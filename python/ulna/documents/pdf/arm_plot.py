"""The arm on paper: the same marks as on the page, drawn by Matplotlib."""

from __future__ import annotations

from typing import Any

from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

from ulna.documents.content.standing import StandingArm
from ulna.documents.pdf.canvas import INCH_MM, WIDTH_MM, svg_of
from ulna.pictures.looks import LIGHT, LOOKS, Look
from ulna.pictures.svg import scale_bar
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, NAME_PX, Mark, fitted, marks

PX_PER_MM = 4.6
"""A mark's size is stated in px of a screen; so many are a millimetre on paper."""
MOST_MM = 120.0
POINTS_PER_PX = 72.0 / INCH_MM / PX_PER_MM
GROUPS = ("arm", "axes", "frames", "floor")


def arm(found: StandingArm) -> str:
    """Seen obliquely, with axes, frames and the floor; SVG."""
    width_px = WIDTH_MM * PX_PER_MM
    view = fitted(found.scene, found.q_rad, width_px, MOST_MM * PX_PER_MM, AZIMUTH_RAD, ELEVATION_RAD)
    height_mm = view.height_px / PX_PER_MM
    figure = Figure(figsize=(WIDTH_MM / INCH_MM, height_mm / INCH_MM))
    axes: Axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0.0, view.width_px)
    axes.set_ylim(view.height_px, 0.0)
    axes.set_axis_off()
    seen = [each for each in marks(found.scene, found.q_rad, view) if each.group in GROUPS]
    for k, mark in enumerate([*seen, *scale_bar(view)]):
        _draw(axes, mark, LOOKS[mark.role], k)
    return svg_of(figure)


def _draw(axes: Axes, mark: Mark, look: Look, order: int) -> None:
    fill = None if look.fill is None else LIGHT[look.fill]
    stroke = None if look.stroke is None else LIGHT[look.stroke]
    width = look.width * POINTS_PER_PX
    x, y = mark.points_px.T
    if mark.form == "word":
        halo = [patheffects.withStroke(linewidth=3.0 * POINTS_PER_PX, foreground=LIGHT["paper"])]
        style: Any = {"fontsize": look.size * POINTS_PER_PX, "fontweight": "bold" if look.bold else "normal"}
        axes.text(
            x[0], y[0] - NAME_PX, _plain(mark.text), color=fill, ha="center", va="baseline", zorder=order + 2,
            clip_on=True, path_effects=halo, parse_math=False, **style,
        )  # fmt: skip
    elif mark.form == "line":
        dash: Any = (0, tuple(each / look.width for each in look.dash)) if look.dash else "solid"
        axes.plot(x, y, color=stroke, linewidth=width, linestyle=dash, zorder=order + 2, solid_capstyle="round")
    elif mark.form == "circle":
        axes.add_patch(
            Circle((x[0], y[0]), mark.radius_px, facecolor=fill, edgecolor=stroke, lw=width, zorder=order + 2)
        )
    else:
        edge: Any = stroke if stroke is not None else "none"
        axes.add_patch(Polygon(mark.points_px, facecolor=fill, edgecolor=edge, lw=width, zorder=order + 2))


def _plain(name: str) -> str:
    """A name that can be drawn letter by letter; of any other its number, which is in the table of joints too."""
    return name if name.isascii() and name.isprintable() else name[: len(name) - len(name.lstrip("0123456789"))]
