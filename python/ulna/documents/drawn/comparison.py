"""The drawing of a comparison: where lengths have changed, in two projections, and which parameters, with their U."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure, SubFigure

from ulna.comparison.compare import Compared, Comparison, Moved
from ulna.documents.drawn.residuals import Say
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words
from ulna.ground.digits import figure_mm
from ulna.ground.style import BLUE, GREY, STYLE, VERMILION

WIDE_IN = 11.0
HIGH_IN = 7.6
"""Of one step."""
MOST_PARAMETERS = 30
"""Of one unit; the surest changes."""
LONGEST_LABEL = 60
VIEWS = (("x", "y"), ("x", "z"))


def picture(found: Comparison, say: Say) -> Figure:
    """One calibration after the other, below each other."""
    with rc_context({**STYLE, "font.size": 8.5}):
        figure = Figure(figsize=(WIDE_IN, HIGH_IN * len(found.steps)), layout="constrained")
        parts = np.ravel(figure.subfigures(len(found.steps), 1, squeeze=False))
        for part, step in zip(parts, found.steps, strict=True):
            _step(part, step, say)
    return figure


def drawn(found: Comparison, form: str) -> bytes:
    """The picture in English as "png", "svg" or "pdf"; the same numbers make the same file."""
    words, file = Words("en"), io.BytesIO()
    dated: Any = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
    with rc_context(STYLE):
        figure = picture(found, lambda key, **values: plain(words(key, **values)))
        figure.savefig(file, format=form, dpi=160, metadata=dated[form])
    return file.getvalue()


def _step(part: SubFigure, step: Compared, say: Say) -> None:
    units = list(dict.fromkeys(each.unit for each in step.parameters))
    above, below = np.ravel(part.subfigures(2, 1, squeeze=False, height_ratios=(1.15, 1.0)))
    part.suptitle(f"{_short(step.before)} → {_short(step.after)}", fontsize=10, parse_math=False)
    _volume(above, step, say)
    if units:
        rows = [[each for each in step.parameters if each.unit == unit][:MOST_PARAMETERS] for unit in units]
        for axes, unit, own in zip(np.ravel(below.subplots(1, len(units), squeeze=False)), units, rows, strict=True):
            parameters(axes, own, unit, step.k, say)


def _volume(part: SubFigure, step: Compared, say: Say) -> None:
    """Two projections with one scale of colours."""
    pair = np.ravel(part.subplots(1, 2, squeeze=False))
    for axes, view in zip(pair, VIEWS, strict=True):
        shown = changes(axes, step, view, say)
    if len(step.changes.change_mm):
        part.colorbar(shown, ax=list(pair), label=say("compare.change"), shrink=0.9)
        largest = step.largest
        if largest is not None:
            values = {"change": (figure_mm(largest.largest_mm),), "expanded": (figure_mm(largest.expanded_mm),)}
            pair[0].set_title(say("compare.largest", **values), loc="left", fontsize=8.5, color=VERMILION)


def changes(axes: Axes, step: Compared, view: tuple[str, str], say: Say) -> PathCollection:
    """A dot in the middle of each length, the largest changes on top, the largest of all marked."""
    found = step.changes
    order = np.argsort(np.abs(found.change_mm), kind="stable")
    across, up = (found.middle_mm[order, "xyz".index(axis)] for axis in view)
    most = float(np.abs(found.change_mm).max(initial=0.0)) or 1.0
    shown = axes.scatter(across, up, c=found.change_mm[order], s=9.0, cmap="PuOr", vmin=-most, vmax=most, linewidths=0)
    if len(order):
        axes.plot(across[-1:], up[-1:], "o", markersize=11, markeredgecolor=VERMILION, markerfacecolor="none")
    axes.set_aspect("equal", adjustable="datalim")
    axes.grid(color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel(say(f"axis.{view[0]}-mm"))
    axes.set_ylabel(say(f"axis.{view[1]}-mm"))
    return shown


def parameters(axes: Axes, rows: list[Moved], unit: str, k: float, say: Say) -> None:
    """A bar for each change, with U about it; those beyond U in blue."""
    y = np.arange(len(rows))[::-1]
    delta = np.array([each.delta for each in rows])
    expanded = k * np.array([each.u for each in rows])
    colours = [BLUE if beyond else GREY for beyond in np.abs(delta) > expanded]
    axes.barh(y, delta, height=0.65, color=colours)
    axes.errorbar(delta, y, xerr=expanded, fmt="none", ecolor="black", elinewidth=0.8, capsize=2.0)
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.set_yticks(y, [each.name for each in rows], fontsize=6.5, parse_math=False)
    axes.set_ylim(-0.7, len(rows) - 0.3)
    axes.ticklabel_format(axis="x", style="sci", scilimits=(-3, 4))
    axes.grid(axis="x", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel(say("compare.parameter", unit=(unit,)))


def _short(label: str) -> str:
    """Its end, where a path is long."""
    return label if len(label) <= LONGEST_LABEL else f"…{label[1 - LONGEST_LABEL :]}"
