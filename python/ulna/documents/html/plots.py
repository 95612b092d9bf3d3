"""What plots of Plotly share: a plot with its caption, axes with units, colours that change with the theme.

Colours are those of Okabe and Ito (2008), which colour-blind readers can tell apart, and every kind of mark has a
shape of its own besides. A colour here is a name such as "@main"; the page's script puts in that of the theme.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from ulna.documents.languages.text import Text

DIGITS = 6
"""Of numbers in plots: more than a screen can show."""

MAIN, OUTLIER, INK, GOOD, UNDECIDED, GRID = "@main", "@outlier", "@ink", "@second", "@undecided", "@grid"


@dataclass(frozen=True)
class Plot:
    """One plot."""

    name: str
    """Unique in the page, letters and hyphens."""
    data: list[dict[str, Any]]
    layout: dict[str, Any]
    caption: Text = ()
    """What must be said of what is shown."""
    height_px: int = 340
    solid: bool = False
    """Three-dimensional: drawn by WebGL."""

    @property
    def place(self) -> Markup:
        """Where the page's script draws it."""
        return Markup('<div class="plot" id="plot-{}" style="height:{}px"></div>').format(self.name, self.height_px)


@dataclass(frozen=True)
class Still:
    """A picture that no script draws."""

    name: str
    place: Markup
    """SVG, in colours of the page's style."""
    caption: Text = ()


def numbers(values: ArrayLike) -> list[float | None]:
    """JSON numbers, rounded; None where not finite."""
    given = np.asarray(values, dtype=np.float64).ravel()
    return [float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None for value in given.tolist()]


def axis(title: str, **more: Any) -> dict[str, Any]:
    """An axis with its title, the unit in it."""
    return {
        "title": {"text": title, "standoff": 8},
        "gridcolor": GRID,
        "zerolinecolor": "@axis",
        "linecolor": "@axis",
        "automargin": True,
        "exponentformat": "power",  # not 200f and 10k
        **more,
    }


def layout(x: Mapping[str, Any], y: Mapping[str, Any], legend: bool = False, **more: Any) -> dict[str, Any]:
    """Of a plane plot."""
    return {
        "xaxis": dict(x),
        "yaxis": dict(y),
        "showlegend": legend,
        "legend": {"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom"},
        "margin": {"l": 56, "r": 12, "t": 56 if legend else 34, "b": 48},
        "hovermode": "closest",
        **more,
    }


def points(
    label: str, x: ArrayLike, y: ArrayLike, colour: str, symbol: str = "circle", size: float = 5, **more: Any
) -> dict[str, Any]:
    """Marks without lines."""
    return {
        "type": "scatter",
        "mode": "markers",
        "name": label,
        "x": numbers(x),
        "y": numbers(y),
        "marker": {"color": colour, "symbol": symbol, "size": size, "opacity": 0.75 if colour == MAIN else 1},
        **more,
    }


def line(label: str, x: ArrayLike, y: ArrayLike, colour: str, dash: str = "solid", **more: Any) -> dict[str, Any]:
    """A line without marks."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": label,
        "x": numbers(x),
        "y": numbers(y),
        "line": {"color": colour, "dash": dash, "width": 2},
        **more,
    }
