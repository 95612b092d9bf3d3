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
    ways: list[Literal["token", "password", "provider"]]
    """How one signs in."""
    provider: str | None
    """What the provider is called, where one signs in at one."""
    languages: list[str]


class LoginToken(Asked):
    """With the token of the address that `ulna workbench` printed."""

    way: Literal["token"]
    token: Annotated[str, Field(min_length=1, max_length=200)]


class LoginPassword(Asked):
    """With a name and its password."""

    way: Literal["password"]
    name: Name
    password: Annotated[str, Field(min_length=1, max_length=1000)]


Login = Annotated[LoginToken | LoginPassword, Field(discriminator="way")]


class PasswordAsked(Asked):
    """Another password for whoever is signed in."""

    now: Annotated[str, Field(min_length=1, max_length=1000)]
    new: Annotated[str, Field(min_length=1, max_length=1000)]


class Me(Said):
    """Who is signed in."""

    name: Name
    roles: list[Literal["reader", "operator", "reviewer", "admin"]]
    password: bool
    """Whether a password of theirs can be changed here."""


class Play(Said):
    """A virtual arm, ready to be tried: what to begin with."""

    arm: Sha256
    plan: Sha256
    source: str
    goal_mm: float
    """U (k = 2) of a length that it can be touched to in a few minutes."""
    length_mm: float
    """That length."""
