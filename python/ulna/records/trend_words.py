"""A figure over time, in words."""

from __future__ import annotations

from ulna.ground.digits import figure_mm, quantity
from ulna.records.history import Point
from ulna.records.trend import Trend


def figure_said(value: float, of: Point) -> str:
    """A figure in mm; a parameter in its unit, as its u has it."""
    if of.unit == "mm" or of.u is None:
        return figure_mm(value)
    return quantity(value, of.u, of.unit)


def chart_said(found: Trend) -> str:
    """Whether the newest is in control, and by which limits."""
    chart, limits, of = found.chart, found.chart.limits, found.points[-1]
    if limits.lower is None or limits.upper is None:
        return f"{limits.basis.said}; nothing is said of control."
    said = f"limits {figure_said(limits.lower, of)} to {figure_said(limits.upper, of)}, of the first {found.baseline}"
    if chart.in_control is None:
        return f"{said}: no figure came after them."
    why = [
        *(["beyond the limits"] if chart.beyond else []),
        *(["the average has left the mean"] if chart.drifted else []),
    ]
    verdict = f"the newest is out of control ({'; '.join(why)})" if why else "the newest is in control"
    earlier = sum(int(k) < chart.new - 1 for k in limits.outside)
    told = [f"{earlier} earlier outside"] if earlier else []
    told += [run.words for run in (chart.rows.ending(chart.new - 1) if chart.rows else ())]
    besides = f"; told besides: {', '.join(told)}" if told else ""
    return f"{said}: {verdict}{besides}."
