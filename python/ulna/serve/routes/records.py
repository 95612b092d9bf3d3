"""Equipment of the record, and what became of it."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request

from ulna.serve import recorded
from ulna.serve.contract import records as wire
from ulna.serve.contract.filing import Entries, Entry
from ulna.serve.contract.records import Method
from ulna.serve.routes.common import Named, records, workshop

router = APIRouter(prefix="/records/equipment", tags=["records"])
Figure = Annotated[str, Query(min_length=1, max_length=200)]
Word = Annotated[str | None, Query(min_length=1, max_length=200)]
When = Annotated[str | None, Query(min_length=4, max_length=40)]
Number = Annotated[float | None, Query(ge=-1e6, le=1e6)]


@router.get("")
def all_of_it(request: Request, kind: wire.Kind | None = None) -> wire.AllEquipment:
    """By name, or those of a kind."""
    record = records(request)
    due = {each.name: each for each in record.due()}
    rows = record.equipment(kind)
    return wire.AllEquipment(equipment=[recorded.equipment(row, due.get(str(row["name"]))) for row in rows])


@router.post("", status_code=201)
def register(request: Request, asked: wire.RegisterAsked) -> wire.EquipmentWhole:
    """New, or as it is from now on."""
    here = workshop(request)
    details = asked.model_dump(include=set(recorded.DETAILS))
    records(request).register(asked.name, asked.kind, asked.state, **details)
    return recorded.whole(records(request), here.desk, asked.name)


@router.get("/{name}")
def one(request: Request, name: Named) -> wire.EquipmentWhole:
    """One thing: history, figures that there are, calibrations, certificates."""
    here = workshop(request)
    return recorded.whole(records(request), here.desk, name)


@router.get("/{name}/figures")
def figures(
    request: Request, name: Named, figure: Figure, state: Word = None, artefact: Word = None
) -> wire.FigurePoints:
    """A figure over time."""
    found = records(request).figures(name, figure, state, artefact)
    return wire.FigurePoints(points=[recorded.point(each) for each in found])


@router.get("/{name}/trend")
def trend(
    request: Request,
    name: Named,
    figure: Figure,
    state: Word = None,
    artefact: Word = None,
    since: When = None,
    limit: Number = None,
    guard: Annotated[float, Query(ge=0, le=1e6)] = 0.0,
    baseline: Annotated[int | None, Query(ge=1, le=10_000)] = None,
) -> wire.Trend:
    """The same with drift, limit and control chart."""
    more: dict[str, Any] = {"state": state, "artefact": artefact, "since": since, "limit": limit}
    found = records(request).trend(name, figure, **more, guard=guard, baseline=baseline)
    return recorded.trend_said(found)


@router.get("/{name}/advice")
def advice(
    request: Request,
    name: Named,
    figure: Word = None,
    limit: Number = None,
    guard: Annotated[float, Query(ge=0, le=1e6)] = 0.0,
    target: Annotated[float, Query(gt=0.5, lt=1)] = 0.95,
) -> wire.AllAdvice:
    """When it should come back, by each method; by drift only of a figure that is named."""
    record = records(request)
    methods: list[Method] = ["staircase", "a3", *(["drift"] if figure is not None else [])]  # type: ignore[list-item]
    more = {"figure": figure, "limit": limit, "guard": guard, "target": target}
    return wire.AllAdvice(advice=[recorded.advice_said(record.advise(name, each, **more)) for each in methods])


@router.post("/{name}/interval", status_code=201)
def interval(request: Request, name: Named, asked: wire.IntervalAsked) -> Entries:
    """Somebody decides when it must come back."""
    entry = records(request).interval(name, asked.days, asked.method, asked.why)
    return Entries(entries=[Entry(number=entry.seq, subject=entry.subject)])


@router.get("/{name}/impact")
def impact(request: Request, name: Named, since: When = None, until: When = None) -> wire.Impact:
    """What was done between the last good figure and the first bad one, or between stated times."""
    return recorded.impact_said(records(request).impact(name, since, until))


@router.post("/{name}/events", status_code=201)
def event(request: Request, name: Named, asked: wire.EventAsked) -> Entries:
    """What happened to it; a quarantine, or its end, changes whether it may be used."""
    here = workshop(request)
    file = None if asked.file is None else here.desk.path(asked.file)
    made = records(request).event(name, asked.kind, asked.text, asked.at, file)
    return Entries(entries=[Entry(number=each.seq, subject=each.subject) for each in made])
