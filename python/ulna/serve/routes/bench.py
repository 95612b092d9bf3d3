"""The first screen."""

from __future__ import annotations

from datetime import UTC, date, datetime

from fastapi import APIRouter, Request

from ulna.records.due import Due
from ulna.records.records import Records
from ulna.serve.contract import bench as wire
from ulna.serve.routes.common import records, workshop

router = APIRouter(prefix="/bench", tags=["bench"])
ARMS = ("arm", "robot")


@router.get("")
def bench(request: Request) -> wire.BenchInfo:
    """Arms of the record with how they stand, and sessions that can go on."""
    here = workshop(request)
    record = records(request)
    due = {each.name: each for each in record.due()}
    cards = [_card(record, row, due.get(str(row["name"]))) for kind in ARMS for row in record.equipment(kind)]
    return wire.BenchInfo(cards=cards, unfinished=here.hall.all().unfinished)


def _card(records: Records, row: dict[str, object], due: Due | None) -> wire.Card:
    name = str(row["name"])
    calibrations = records.calibrations(name)
    newest = calibrations[-1] if calibrations else None
    checked = records.last_of(name, "check")
    calibrated_at = None if newest is None else str(newest["at"])
    return wire.Card(
        name=name,
        kind=str(row["kind"]),
        maker=_said(row["maker"]),
        model=_said(row["model"]),
        serial=_said(row["serial"]),
        state=str(row["state"]),
        calibration=None if newest is None else str(newest["sha256"]),
        calibrated_at=calibrated_at,
        calibrated_days=None if calibrated_at is None else _days_since(calibrated_at),
        converged=None if newest is None else bool(newest["converged"]),
        checked_at=None if checked is None else checked.at,
        check=None if checked is None else checked.verdict,
        due_on=None if due is None else due.due,
        due_days=None if due is None else due.days,
    )


def _said(value: object) -> str | None:
    return None if value is None else str(value)


def _days_since(at: str) -> int:
    return (datetime.now(UTC).date() - date.fromisoformat(at[:10])).days
