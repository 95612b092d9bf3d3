"""What all routes share."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import Path, Request

from ulna.records.records import Records
from ulna.serve.contract.model import Problem
from ulna.serve.guarding import WHO
from ulna.serve.people import Person
from ulna.serve.workshop import Workshop

Digest = Annotated[str, Path(pattern=r"^[0-9a-f]{64}$")]
Named = Annotated[str, Path(min_length=1, max_length=200)]
PROBLEMS: dict[int | str, dict[str, Any]] = {
    status: {"model": Problem, "content": {"application/problem+json": {}}}
    for status in (400, 401, 403, 404, 409, 413, 422)
}


def workshop(request: Request) -> Workshop:
    """Whose routes they are."""
    found: Workshop = request.app.state.workshop
    return found


def who(request: Request) -> Person:
    """Who asks."""
    found: Person = request.scope[WHO]
    return found


def records(request: Request) -> Records:
    """The record, with whoever asks at work."""
    return workshop(request).records.worked_by(who(request).name)
