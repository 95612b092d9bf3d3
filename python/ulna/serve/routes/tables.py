"""Tables of readings that somebody brings: looked at, and made into studies."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.serve import tables
from ulna.serve.contract import tables as wire
from ulna.serve.routes.common import workshop

router = APIRouter(tags=["tables"])


@router.post("/tables/look")
def look(request: Request, asked: wire.StudyAsked) -> wire.Looked:
    """Rows as they stand, what columns are taken for, what is asked, what is wrong; nothing is written."""
    return tables.looked(workshop(request).desk, asked)


@router.post("/studies", status_code=201)
def make(request: Request, asked: wire.StudyAsked) -> wire.StudyMade:
    """The study, as `ulna new` writes it; a job calibrates it."""
    return tables.study_made(workshop(request), asked)
