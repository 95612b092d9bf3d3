"""Certificates that wait for a second person."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.serve.contract import proposals as wire
from ulna.serve.contract.filing import IssueAsked
from ulna.serve.routes.common import Named, records, who, workshop

router = APIRouter(prefix="/records/proposals", tags=["records"])


@router.get("")
def proposals(request: Request) -> wire.Proposals:
    """The newest first."""
    return wire.Proposals(proposals=workshop(request).proposals.all(who(request).name))


@router.post("", status_code=201)
def propose(request: Request, asked: IssueAsked) -> wire.Proposal:
    """A certificate that another person shall look at."""
    return workshop(request).proposals.propose(asked, who(request).name)


@router.post("/{name}/approve")
def approve(request: Request, name: Named) -> wire.Proposal:
    """It is issued, in the name of both."""
    return workshop(request).proposals.approve(name, who(request).name, records(request))


@router.post("/{name}/decline")
def decline(request: Request, name: Named, asked: wire.DeclineAsked) -> wire.Proposal:
    """It is not, and why."""
    return workshop(request).proposals.decline(name, who(request).name, asked.reason)
