"""What `ulna record trend` and `ulna record interval` print."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import table
from ulna.control.drift import Drift
from ulna.records.advising import Advice
from ulna.records.history import Series
from ulna.records.trend import Trend
from ulna.records.trend_words import chart_said, figure_said

_LATEST = 12


def series_report(arm: str, found: Sequence[Series]) -> list[RenderableType]:
    """Which figures there are."""
    if not found:
        return [Text(f"No figure of {arm} yet. File what you measured: ulna record add FILE")]
    rows = [(each.name, each.state, each.artefact or "", each.last[:10], str(each.count)) for each in found]
    return [table(f"Figures of {arm}", ("figure", "state", "of", "last", "count"), rows, left=4)]


def trend_report(found: Trend, everything: bool) -> list[RenderableType]:
    """The figures, the line, the limit, the chart."""
    points = found.points if everything else found.points[-_LATEST:]
    first = len(found.points) - len(points)
    outside = {found.baseline + int(k) for k in found.chart.limits.outside}
    rows = [
        (
            each.at[:10],
            each.source,
            each.verdict or "",
            "outside" if k in outside else "",
            figure_said(each.value, each),
            "-" if each.u is None else figure_said(each.u, each),
        )
        for k, each in enumerate(points, start=first)
    ]
    heads = ("day", "of", "verdict", "chart", f"{found.points[0].unit}", "u")
    parts: list[RenderableType] = [table(f"{found.figure} of {found.arm}", heads, rows, left=4)]
    if first:
        parts.append(Text(f"{first} earlier: --all."))
    parts += ["", Text(f"Drift: {found.drift.said}")]
    if found.until is not None:
        parts.append(Text(f"Limit: {found.until.reason}"))
    parts.append(Text(f"Chart: {chart_said(found)}"))
    if found.breaks:
        parts.append(Text(f"Meanwhile: {'; '.join(found.breaks)}. With --since DAY only what came after."))
    return parts


def trend_document(found: Trend) -> dict[str, Any]:
    """The machine form."""
    until = found.until
    return {
        "format": "ulna-trend/1",
        "arm": found.arm,
        "figure": found.figure,
        "points": [asdict(each) for each in found.points],
        "drift": _drift(found.drift),
        "until": until and {"days": until.interval_days, "meets_days": until.meets_days, "reason": until.reason},
        "chart": _chart_document(found),
        "breaks": found.breaks,
    }


def _drift(found: Drift) -> dict[str, Any]:
    basis, line = found.basis, found.line
    return {
        "method": basis.method,
        "n": basis.n,
        "span_days": basis.span_days,
        "too_few": basis.too_few,
        "per_day": None if line is None else line.slope,
        "u_per_day": None if line is None else line.u_slope,
        "p_value": found.p_value,
        "drifts": found.drifts,
        "birge": found.birge,
    }


def _chart_document(found: Trend) -> dict[str, Any]:
    chart, first = found.chart, found.baseline
    return {
        "baseline": first,
        "centre": chart.limits.centre,
        "lower": chart.limits.lower,
        "upper": chart.limits.upper,
        "outside": [first + int(k) for k in chart.limits.outside],
        "averages_outside": [first + int(k) for k in chart.averages.outside],
        "rows": [asdict(run) for run in (chart.rows.found if chart.rows else ())],
        "in_control": chart.in_control,
    }


def advice_report(found: Sequence[Advice]) -> list[RenderableType]:
    """One method a row; why below."""
    rows = [
        (
            each.method,
            str(each.n),
            "-" if each.now_days is None else f"{each.now_days:.0f}",
            "too few" if each.days is None else f"{each.days:.0f}",
        )
        for each in found
    ]
    made = table("", ("method", "rests on", "now / days", "advised / days"), rows)
    return [made, "", *(Text(f"{each.method}: {each.reason}") for each in found)]
