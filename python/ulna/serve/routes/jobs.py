"""Long work."""

from __future__ import annotations

import secrets

from fastapi import APIRouter, Request

from ulna.serve.contract.jobs import BeginJob, Job, Jobs
from ulna.serve.routes.common import Named, who, workshop
from ulna.serve.work import planned

router = APIRouter(prefix="/jobs", tags=["jobs"])


@router.get("")
def jobs(request: Request) -> Jobs:
    """All since the server began, the newest first."""
    return workshop(request).jobs.all()


@router.post("", status_code=201)
def begin(request: Request, asked: BeginJob) -> Job:
    """One more; it waits until those before it are done."""
    here = workshop(request)
    title, work = planned(asked, here, here.jobs_folder / secrets.token_hex(8))
    return here.jobs.begin(asked.kind, title, work, who(request).name)


@router.get("/{name}")
def job(request: Request, name: Named) -> Job:
    """One."""
    return workshop(request).jobs.job(name)


@router.post("/{name}/cancel")
def cancel(request: Request, name: Named) -> Job:
    """It stops where it can; nothing half written stays."""
    return workshop(request).jobs.cancel(name)
