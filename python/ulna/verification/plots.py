"""The picture of a length test: error against length, with the limits and their guard bands."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ulna.ground.arrays import F64
from ulna.ground.style import GREY, OF_VERDICT, ORANGE, STYLE, save_picture
from ulna.verification.kinds.registry import kind_of
from ulna.verification.outcome import FigureResult, StateResult

MARKS = {
    "pass": ("o", OF_VERDICT["pass"], "passes"),
    "undecided": ("D", OF_VERDICT["undecided"], "undecided"),
    "fail": ("X", OF_VERDICT["fail"], "fails"),
}
NO_VERDICT = ("o", OF_VERDICT[None], "no limit stated")


def draw_lengths(states: list[StateResult], folder: Path) -> None:
    """`lengths.svg` and `lengths.png`: one panel for each length test, a column for each state."""
    tested = [
        (state.state, test.figures[0]) for state in states for test in state.tests if kind_of(test.kind).length_errors
    ]
    names = list(dict.fromkeys(figure.definition.name for _, figure in tested))
    columns = list(dict.fromkeys(state for state, _ in tested))
    # one state: the tests side by side; two: a row for each test, so that the states stand side by side
    rows, across = (1, len(names)) if len(columns) == 1 else (len(names), len(columns))
    with rc_context(STYLE):
        figure = Figure(figsize=(4.4 * across + 0.4, 2.9 * rows + 0.5), layout="constrained")
        panels = figure.subplots(rows, across, squeeze=False, sharey="row" if len(columns) > 1 else False, sharex=True)
        empty = set(panels.flat)
        for state, found in tested:
            row, column = names.index(found.definition.name), columns.index(state)
            axes = panels[row, column] if len(columns) > 1 else panels[0, row]
            empty.discard(axes)
            _panel(axes, found)
            axes.set_title(f"{found.definition.key}, {state}")
        for axes in empty:
            axes.set_axis_off()
        for axes in panels[:, 0]:
            axes.set_ylabel("error / µm")
        for axes in panels[-1]:
            axes.set_xlabel("calibrated length / mm")
        entries = {
            label: handle
            for axes in panels.flat
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
        }
        figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=min(len(entries), 3 * across))
        save_picture(figure, folder, "lengths")


def _panel(axes: Axes, found: FigureResult) -> None:
    length = np.array([judged.single.calibrated_mm for judged in found.values], dtype=np.float64)
    error = 1000.0 * np.array([judged.single.value_mm for judged in found.values])
    axes.axhline(0.0, color="0.8", linewidth=0.8)
    if found.limit is not None:
        _limits(axes, found, length)
    verdicts = np.array([judged.decided.verdict or "" for judged in found.values])
    for verdict in dict.fromkeys(["pass", "undecided", "fail", ""]):
        own = verdicts == verdict
        if own.any():
            marker, colour, label = MARKS.get(verdict, NO_VERDICT)
            axes.plot(length[own], error[own], linestyle="", marker=marker, markersize=4.5, color=colour, label=label)


def _limits(axes: Axes, found: FigureResult, length: F64) -> None:
    """±MPE as lines, and about each the band of ±g in which nothing is decided."""
    order = np.argsort(length)
    margin = 0.04 * max(float(np.ptp(length)), 1.0)
    at = np.concatenate([[length.min() - margin], length[order], [length.max() + margin]])
    assert found.limit is not None
    limit = 1000.0 * np.array([found.limit.at_mm(each) for each in at])
    guards = np.array([1000.0 * (judged.decided.guard_mm or 0.0) for judged in found.values])[order]
    guard = np.concatenate([guards[:1], guards, guards[-1:]])
    for sign in (1.0, -1.0):
        label = "±MPE" if sign > 0 else None
        axes.plot(at, sign * limit, color=GREY, linewidth=1.2, label=label)
        if guard.any():
            axes.fill_between(
                at,
                sign * (limit - guard),
                sign * (limit + guard),
                color=ORANGE,
                alpha=0.22,
                linewidth=0,
                label="guard band ±g" if sign > 0 else None,
            )
    axes.set_xlim(at[0], at[-1])
