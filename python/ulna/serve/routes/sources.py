"""Ports of this machine, and what a source sends."""

from __future__ import annotations

from fastapi import APIRouter, Request

from ulna.live.guessing import guess as guessed
from ulna.live.listening import listened
from ulna.live.ports import ports as found
from ulna.serve.activities.opened import stated_source
from ulna.serve.contract import sources as wire
from ulna.serve.routes.common import workshop

router = APIRouter(prefix="/sources", tags=["sources"])
LINES, LONGEST = 20, 200


@router.get("/ports")
def ports(request: Request) -> wire.Ports:
    """Serial ports, and what is plugged in."""
    return wire.Ports(ports=[wire.Port(url=each.url, what=each.what) for each in found()])


@router.post("/guess")
def guess(request: Request, asked: wire.GuessAsked) -> wire.Guessed:
    """Listens, and proposes how to read it; nothing is taken as it is guessed."""
    stated = stated_source(workshop(request).desk, asked.source, workshop(request).allowed)
    heard = listened(stated, asked.seconds)
    proposal = guessed(heard.pieces, heard.messages)
    lines = b"".join(piece for _, piece in heard.pieces).splitlines()[:LINES]
    return wire.Guessed(
        lines=[_shown(line) for line in lines],
        kind=proposal.kind,
        sentences=proposal.reasons,
        fields=[wire.LineField(name=each.name, role=each.role, why=each.why) for each in proposal.fields],
        bytes=heard.bytes,
        source_toml=proposal.toml(stated.file.url) if proposal.decode else None,
    )


def _shown(line: bytes) -> str:
    return line.decode("utf-8", "backslashreplace").encode("unicode_escape").decode("ascii")[:LONGEST]
