"""The record as it goes over the wire."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ulna.ground.worded import recalled, templates
from ulna.records import advising, history, impact, trend
from ulna.records.due import Due
from ulna.records.records import Records
from ulna.records.trend_words import chart_said
from ulna.serve.contract import records as wire
from ulna.serve.contract.model import shortened
from ulna.serve.desk import Desk
from ulna.serve.problems import NotThereError
from ulna.serve.texts import valued

WHATS = templates(
    "registered",
    "filed",
    "happened",
    "changed",
    "certified",
    "issued",
    "set",
    "interval",
    "knock",
    "repair",
    "move",
    "adjustment",
    "firmware",
    "quarantine",
    "release",
    "note",
    "arm",
    "calibration",
    "check",
    "verification",
    "evaluation",
    "cross-validation",
    "file",
    "rests on it",
)
"""What may have become of a thing, in a word."""
DETAILS = ("part_of", "maker", "model", "serial", "firmware", "owner", "location", "remark")


def equipment(row: Mapping[str, Any], due: Due | None) -> wire.Equipment:
    """One thing."""
    return wire.Equipment(
        **{key: row[key] for key in ("name", "kind", "state", *DETAILS)},
        due_on=None if due is None else due.due,
        due_days=None if due is None else due.days,
        due_why=None if due is None else due.why,
    )


def whole(records: Records, desk: Desk, name: str) -> wire.EquipmentWhole:
    """One thing, and what became of it. Raises NotThereError."""
    rows = records.equipment()
    row = next((each for each in rows if each["name"] == name), None)
    if row is None:
        raise NotThereError(f"record: '{name[:80]}' is not registered. Register it.")
    due = next((each for each in records.due() if each.name == name), None)
    is_arm = row["kind"] in ("arm", "robot")
    return wire.EquipmentWhole(
        equipment=equipment(row, due),
        history=[happening(each) for each in reversed(records.history(name))],
        series=[
            wire.Series(figure=each.name, state=each.state, artefact=each.artefact, count=each.count, last=each.last)
            for each in (records.series(name) if is_arm else [])
        ],
        calibrations=[_calibration(each, desk) for each in reversed(records.calibrations(name))] if is_arm else [],
        values=_values(records.certified(name)),
        certificates=[issued(each) for each in records.certificates(name)] if is_arm else [],
    )


def happening(found: history.Happening) -> wire.Happening:
    """One line of a history."""
    return wire.Happening(
        number=found.seq,
        at=found.at,
        what=recalled(found.what, WHATS),
        text=shortened(found.text),
        by=found.by,
        sha256=found.sha256,
    )


def _calibration(row: Mapping[str, Any], desk: Desk) -> wire.FiledCalibration:
    sha256 = str(row["sha256"])
    return wire.FiledCalibration(
        sha256=sha256,
        at=row["at"],
        converged=bool(row["converged"]),
        ending=row["termination"],
        on_desk=desk.has(sha256),
    )


def _values(rows: list[dict[str, Any]]) -> list[wire.CertifiedValue]:
    seen: set[str] = set()
    found = []
    for row in rows:
        found.append(
            wire.CertifiedValue(
                quantity=row["quantity"],
                value=valued(row["value"], row["unit"], row["u"]),
                temperature_c=row["temperature_c"],
                number=row["number"],
                by=row["by"],
                valid_from=row["valid_from"],
                valid_to=row["valid_to"],
                certificate=row["sha256"],
                newest=row["quantity"] not in seen,
            )
        )
        seen.add(row["quantity"])
    return found


def issued(row: Mapping[str, Any]) -> wire.IssuedInfo:
    """A certificate."""
    keys = ("number", "arm", "sha256", "issued_at", "issued_by", "approved_by", "supersedes", "state", "reason")
    return wire.IssuedInfo(**{key: row[key] for key in keys}, result=row["of"])


def point(found: history.Point, outside: bool = False) -> wire.FigurePoint:
    """A figure at one time."""
    expanded = None if found.u is None or found.k is None else found.k * found.u
    return wire.FigurePoint(
        at=found.at,
        value=valued(found.value, found.unit, found.u, expanded),
        limit=None if found.limit is None else valued(found.limit, found.unit),
        verdict=found.verdict,
        source=found.source,
        state=found.state,
        artefact=found.artefact,
        sha256=found.sha256,
        outside=outside,
    )


def trend_said(found: trend.Trend) -> wire.Trend:
    """A figure over time."""
    limits = found.chart.limits
    outside = {found.baseline + int(k) for k in limits.outside}
    sentences = [found.drift.said, *([] if found.until is None else [found.until.reason]), chart_said(found)]
    return wire.Trend(
        arm=found.arm,
        figure=found.figure,
        unit=found.points[0].unit,
        points=[point(each, k in outside) for k, each in enumerate(found.points)],
        baseline=found.baseline,
        centre=limits.centre,
        lower=limits.lower,
        upper=limits.upper,
        in_control=found.chart.in_control,
        drifts=found.drift.drifts,
        interval_days=None if found.until is None else found.until.interval_days,
        sentences=sentences,
        breaks=found.breaks,
    )


def advice_said(found: advising.Advice) -> wire.Advice:
    """By one method."""
    return wire.Advice(
        method=found.method, days=found.days, now_days=found.now_days, rests_on=found.n, reason=found.reason
    )


def impact_said(found: impact.Impact) -> wire.Impact:
    """Between two times."""
    return wire.Impact(
        name=found.name,
        good=found.good,
        bad=found.bad,
        why=found.why,
        touched=[happening(each) for each in found.touched],
        certificates=found.certificates,
    )
