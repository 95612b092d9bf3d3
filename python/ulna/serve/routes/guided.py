"""What is asked before a check or a test is touched step by step; the touching itself is an activity."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.serve import tests_made
from ulna.serve.contract import guided as wire
from ulna.serve.contract.model import Name, Sha256
from ulna.serve.play_tests import play_guided
from ulna.serve.routes.common import workshop

router = APIRouter(prefix="/tests", tags=["tests"])


@router.get("/profiles")
def profiles(request: Request) -> wire.Profiles:
    """Those that come with Ulna."""
    return tests_made.profiles()


@router.get("/wants")
def wants(request: Request, profile: Name, arm: Sha256) -> wire.ProfileWants:
    """What a profile asks of a test with an arm: artefacts with their certificates, limits."""
    return tests_made.wants(workshop(request), profile, arm)


@router.post("", status_code=201)
def make(request: Request, asked: wire.TestAsked) -> wire.TestPlanMade:
    """A test plan on the desk, with what is known filled in."""
    return tests_made.test_made(workshop(request), asked)


@router.post("/play")
def play(request: Request) -> wire.PlayGuided:
    """A virtual arm, a protocol and a short test, put on the desk."""
    return play_guided(workshop(request))
