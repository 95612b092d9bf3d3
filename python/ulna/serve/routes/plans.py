"""Plans: made, looked at, and what planning found. Planning itself is a job."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.arm.given import as_arm
from ulna.serve import plans
from ulna.serve.contract import plans as wire
from ulna.serve.contract.model import Sha256
from ulna.serve.routes.common import Digest, workshop

router = APIRouter(prefix="/plans", tags=["plans"])


@router.post("", status_code=201)
def make(request: Request, asked: wire.PlanAsked) -> wire.PlanInfo:
    """A plan file of what is stated; what is not, as `ulna plan --make-plan` fills it in."""
    return plans.plan_made(workshop(request), asked)


@router.get("/{sha256}")
def plan(request: Request, sha256: Digest, arm: Sha256) -> wire.PlanInfo:
    """A plan file, or a study, for an arm."""
    here = workshop(request)
    return plans.plan_info(here, sha256, as_arm(here.desk.path(arm)))


@router.get("/{sha256}/outcome")
def outcome(request: Request, sha256: Digest) -> wire.PlanOutcome:
    """Of a plan.json: places, order, what a length will be worth over touches."""
    return plans.outcome(sha256, workshop(request).desk.path(sha256))
