"""A figure over time, in words."""

from __future__ import annotations

from ulna.ground.digits import figure_mm, quantity
from ulna.ground.worded import listed, one_by_one, worded
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
        return worded("{basis}; nothing is said of control.", basis=limits.basis.said)
    said = worded(
        "limits {lower} to {upper}, of the first {count}",
        lower=figure_said(limits.lower, of),
        upper=figure_said(limits.upper, of),
        count=found.baseline,
    )
    if chart.in_control is None:
        return worded("{limits}: no figure came after them.", limits=said)
    why = [
        *([worded("beyond the limits")] if chart.beyond else []),
        *([worded("the average has left the mean")] if chart.drifted else []),
    ]
    verdict = (
        worded("the newest is out of control ({why})", why=one_by_one(why))
        if why
        else worded("the newest is in control")
    )
    earlier = sum(int(k) < chart.new - 1 for k in limits.outside)
    told = [worded("{count} earlier outside", count=earlier)] if earlier else []
    told += [run.words for run in (chart.rows.ending(chart.new - 1) if chart.rows else ())]
    if not told:
        return worded("{limits}: {verdict}.", limits=said, verdict=verdict)
    return worded("{limits}: {verdict}; told besides: {told}.", limits=said, verdict=verdict, told=listed(told))
