"""What goes into the record, what counts no longer, what is due; certificates that leave the house."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request

from ulna.ground.worded import worded
from ulna.serve import recorded
from ulna.serve.contract import filing as wire
from ulna.serve.contract.records import AllDue, DueInfo
from ulna.serve.issuing import issued
from ulna.serve.problems import NotAllowedError
from ulna.serve.routes.about import laboratory_of
from ulna.serve.routes.common import records, workshop

router = APIRouter(prefix="/records", tags=["records"])


@router.post("/add", status_code=201)
def add(request: Request, asked: wire.AddAsked) -> wire.Added:
    """Files of the desk, all or none: a result with its study and its readings, a check, a test."""
    here = workshop(request)
    paths = [here.desk.path(each) for each in asked.files]
    found = records(request).add(
        *paths, arm=asked.arm, at=asked.at, artefacts=asked.artefacts, register=asked.register_arm
    )
    return wire.Added(
        filed=[
            wire.FiledInfo(sha256=each.sha256, name=each.path.name, arm=each.arm, kind=each.kind, new=each.new)
            for each in found
        ]
    )


@router.post("/certify", status_code=201)
def certify(request: Request, asked: wire.CertifyAsked) -> wire.Entries:
    """What a certificate says of an artefact."""
    here = workshop(request)
    if asked.artefact not in {str(each["name"]) for each in records(request).equipment()}:
        anew: dict[str, str | None] | None = {}
    else:
        anew = None
    entry = records(request).certify(
        asked.artefact,
        {each.quantity: (each.value_mm, each.u_mm) for each in asked.values},
        certificate=None if asked.certificate is None else here.desk.path(asked.certificate),
        number=asked.number,
        by=asked.by,
        valid_from=asked.valid_from,
        valid_to=asked.valid_to,
        temperature_c=asked.temperature_c,
        expansion_per_k=asked.expansion_per_k,
        expansion_u_per_k=asked.expansion_u_per_k,
        anew=anew,
    )
    return wire.Entries(entries=[wire.Entry(number=entry.seq, subject=entry.subject)])


@router.post("/withdraw", status_code=201)
def withdraw(request: Request, asked: wire.WithdrawAsked) -> wire.Entries:
    """A filed file, or a certificate: it is kept, and counts no longer."""
    entry = records(request).withdraw(asked.subject, asked.reason)
    return wire.Entries(entries=[wire.Entry(number=entry.seq, subject=entry.subject)])


@router.get("/due")
def due(request: Request, on: Annotated[str | None, Query(min_length=4, max_length=40)] = None) -> AllDue:
    """What must come back, the soonest first, seen from a day."""
    return AllDue(
        due=[
            DueInfo(name=each.name, kind=each.kind, state=each.state, due_on=each.due, days=each.days, why=each.why)
            for each in records(request).due(on)
        ]
    )


@router.get("/verify")
def verify(request: Request) -> wire.Verified:
    """Chain, files and rows, all of them."""
    found = records(request).verify()
    return wire.Verified(
        good=found.good,
        entries=found.entries,
        files=found.files,
        rows=found.rows,
        head=found.head,
        wrong=[each[:4000] for each in found.wrong],
        remarks=[each[:4000] for each in found.remarks],
    )


@router.get("/certificates")
def certificates(
    request: Request, arm: Annotated[str | None, Query(min_length=1, max_length=200)] = None
) -> wire.Certificates:
    """That were issued."""
    return wire.Certificates(certificates=[recorded.issued(each) for each in records(request).certificates(arm)])


@router.post("/issue", status_code=201)
def issue(request: Request, asked: wire.IssueAsked) -> wire.IssuedNow:
    """A certificate with its number and the record's head on it, entered and on the desk; or nothing of it. Where
    people sign in, a second one approves with their own name, not by being named."""
    if asked.approved_by is not None and laboratory_of(request) is not None:
        raise NotAllowedError(
            worded(
                "approved_by: got '{name}'; expected nothing: who approves signs in. Propose it.",
                name=asked.approved_by,
            )
        )
    return issued(workshop(request).desk, records(request), asked)
