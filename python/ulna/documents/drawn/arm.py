"""The arm on axes of Matplotlib: the same marks as on the page."""

from __future__ import annotations

from typing import Any

from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from ulna.documents.content.standing import StandingArm
from ulna.pictures.looks import LIGHT, LOOKS, Look
from ulna.pictures.svg import scale_bar
from ulna.pictures.view import AZIMUTH_RAD, ELEVATION_RAD, NAME_PX, Mark, View, fitted, marks

GROUPS = ("arm", "axes", "frames", "floor")


def seen(found: StandingArm, wide_px: float, most_px: float) -> View:
    """Obliquely, so wide and at most so high, in px of a screen."""
    return fitted(found.scene, found.q_rad, wide_px, most_px, AZIMUTH_RAD, ELEVATION_RAD)


def arm(axes: Axes, found: StandingArm, view: View, points_per_px: float) -> None:
    """With axes, frames, the floor and a scale. points_per_px: of letters and lines, whose sizes are in px of a
    screen."""
    axes.set_xlim(0.0, view.width_px)
    axes.set_ylim(view.height_px, 0.0)
    axes.set_axis_off()
    every = [each for each in marks(found.scene, found.q_rad, view) if each.group in GROUPS]
    for k, mark in enumerate([*every, *scale_bar(view)]):
        _draw(axes, mark, LOOKS[mark.role], k, points_per_px)


def _draw(axes: Axes, mark: Mark, look: Look, order: int, points_per_px: float) -> None:
    fill = None if look.fill is None else LIGHT[look.fill]
    stroke = None if look.stroke is None else LIGHT[look.stroke]
    width = look.width * points_per_px
    x, y = mark.points_px.T
    if mark.form == "word":
        halo = [patheffects.withStroke(linewidth=3.0 * points_per_px, foreground=LIGHT["paper"])]
        style: Any = {"fontsize": look.size * points_per_px, "fontweight": "bold" if look.bold else "normal"}
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
