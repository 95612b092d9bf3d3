"""What is done with a stream."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.serve.contract.activities import Activities, Activity, Begin
from ulna.serve.contract.words import Do
from ulna.serve.routes.common import Named, who, workshop

router = APIRouter(prefix="/activities", tags=["activities"])


@router.get("")
def activities(request: Request) -> Activities:
    """What runs, and sessions that were interrupted."""
    return workshop(request).hall.all()


@router.post("", status_code=201)
def begin(request: Request, asked: Begin) -> Activity:
    """One begins; one at a time, as there is one arm in the hand."""
    return workshop(request).hall.begin(asked, who(request).name)


@router.get("/{name}")
def activity(request: Request, name: Named) -> Activity:
    """How it stands."""
    return workshop(request).hall.activity(name)


@router.post("/{name}/do")
def do(request: Request, name: Named, asked: Do) -> Activity:
    """Does what is said."""
    return workshop(request).hall.say(name, asked)
