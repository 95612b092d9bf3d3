"""The arm on paper: the same marks as on the page, drawn by Matplotlib."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ulna.documents.content.standing import StandingArm
from ulna.documents.drawn import arm as drawn
from ulna.documents.pdf.canvas import INCH_MM, WIDTH_MM, svg_of

PX_PER_MM = 4.6
"""A mark's size is stated in px of a screen; so many are a millimetre on paper."""
MOST_MM = 120.0
POINTS_PER_PX = 72.0 / INCH_MM / PX_PER_MM


def arm(found: StandingArm) -> str:
    """Seen obliquely, with axes, frames and the floor; SVG."""
    view = drawn.seen(found, WIDTH_MM * PX_PER_MM, MOST_MM * PX_PER_MM)
    figure = Figure(figsize=(WIDTH_MM / INCH_MM, view.height_px / PX_PER_MM / INCH_MM))
    axes: Axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    drawn.arm(axes, found, view, POINTS_PER_PX)
    return svg_of(figure)
