"""Sources of readings: ports of this machine, and what a stream looks like."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ulna.serve.contract.model import Asked, Said, Sentence

Source = Annotated[
    str,
    Field(
        min_length=1,
        max_length=2000,
        description="A URL (serial:, tcp:, ws:, …), or the SHA-256 of a source file or a recording of the desk.",
    ),
]


class Port(Said):
    """A serial port."""

    url: str
    what: str


class Ports(Said):
    """Of this machine."""

    ports: list[Port]


class GuessAsked(Asked):
    """What comes, listened to for a time."""

    source: Source
    seconds: Annotated[float, Field(gt=0.1, le=30.0)] = 3.0


class LineField(Said):
    """One number of a line or a message."""

    name: str
    role: str
    """channel, clock, button, counter or constant."""
    why: Sentence


class Guessed(Said):
    """What was heard, and what it is taken for; nothing is taken until somebody says so."""

    lines: list[str]
    """Some, as they came, with what cannot be printed escaped."""
    kind: str
    """fields, json, or nothing that is known."""
    sentences: list[Sentence]
    """What it is taken for, and why, as `ulna live guess` says it."""
    fields: list[LineField]
    bytes: int
    source_toml: str | None
    """The source file that it would be; None where nothing is proposed."""
