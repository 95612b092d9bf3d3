"""What checks and acceptance tests found; they are done by jobs."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.serve import outcomes
from ulna.serve.contract import outcomes as wire
from ulna.serve.routes.common import Digest, workshop

router = APIRouter(tags=["outcomes"])


@router.get("/checks/{sha256}")
def check(request: Request, sha256: Digest) -> wire.CheckOutcome:
    """Each figure with its limit, its history, and what to try where it is out."""
    return outcomes.checked(sha256, workshop(request).desk.path(sha256))


@router.get("/verifications/{sha256}")
def verification(request: Request, sha256: Digest) -> wire.VerificationOutcome:
    """Each figure with its limit and verdict, as found and as left."""
    return outcomes.verified(sha256, workshop(request).desk.path(sha256))
