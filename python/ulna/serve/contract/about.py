"""Who speaks, and who is spoken to."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said, Sha256


class About(Said):
    """The program and the bench that it serves."""

    version: str
    contract: str
    bench: str
    """Name of its folder."""
    database: Literal["sqlite", "postgresql"]
    mode: Literal["local", "laboratory"]
    languages: list[str]


class Login(Asked):
    """With the token of the address that `ulna workbench` printed."""

    token: Annotated[str, Field(min_length=1, max_length=200)]


class Me(Said):
    """Who is signed in."""

    name: Name
    roles: list[str]


class Play(Said):
    """A virtual arm, ready to be tried: what to begin with."""

    arm: Sha256
    plan: Sha256
    source: str
    goal_mm: float
    """U (k = 2) of a length that it can be touched to in a few minutes."""
    length_mm: float
    """That length."""
