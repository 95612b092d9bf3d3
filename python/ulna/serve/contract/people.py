"""People of a laboratory, and how their record is kept."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.serve.contract.model import Asked, Name, Said

Roles = Annotated[list[Literal["reader", "operator", "reviewer", "admin"]], Field(max_length=4)]


class PersonInfo(Said):
    """Somebody whom the record knows."""

    name: Name
    roles: list[Literal["reader", "operator", "reviewer", "admin"]]
    """None: gone."""
    password: bool
    """Whether one is set."""
    sign_in: str | None
    """As the provider has it."""


class People(Said):
    """By name."""

    people: list[PersonInfo]


class PersonAsked(Asked):
    """Somebody, in which roles from now on; none: gone."""

    name: Name
    roles: Roles


class AccountAsked(Asked):
    """How somebody signs in from now on; what is not given stays."""

    password: Annotated[str, Field(min_length=1, max_length=1000)] | None = None
    sign_in: Annotated[str, Field(max_length=200)] | None = None
    """As the provider has it; "": not there any more."""


class SettingsInfo(Said):
    """How the record is kept."""

    four_eyes: bool
    """Whether a certificate needs a second person."""
    numbers: str
    """How certificates are numbered: AB-{year}-{n:04}."""


class SettingsAsked(Asked):
    """What is not given stays."""

    four_eyes: bool | None = None
    numbers: Annotated[str, Field(min_length=1, max_length=60)] | None = None
