"""People of a laboratory, how they sign in, and how the record is kept: an admin's."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request

from ulna.serve.contract import people as wire
from ulna.serve.guests import Guests
from ulna.serve.laboratory.entrance import LaboratoryEntrance
from ulna.serve.problems import NotNowError, NotThereError
from ulna.serve.routes.about import laboratory_of
from ulna.serve.routes.common import Named, records, who

router = APIRouter(tags=["people"])


@router.get("/people")
def people(request: Request) -> wire.People:
    """Everybody whom the record knows."""
    return _people(request)


@router.post("/people", status_code=201)
def person(request: Request, asked: wire.PersonAsked) -> wire.People:
    """Somebody, in which roles from now on."""
    laboratory = laboratory_of(request)
    if asked.name == who(request).name and "admin" not in asked.roles:
        raise NotNowError(f"{asked.name}: you are an admin yourself; expected another to take that away. Ask one.")
    records(request).person(asked.name, asked.roles)
    if laboratory is not None:
        laboratory.forget()
    return _people(request)


@router.post("/people/{name}/account", status_code=201)
def account(request: Request, name: Named, asked: wire.AccountAsked) -> wire.People:
    """How somebody signs in from now on; where they are signed in, they must do so anew."""
    laboratory = _needed(request)
    if name not in records(request).people():
        raise NotThereError(f"record: '{name[:80]}' is not registered. Register them.")
    if asked.password is not None:
        laboratory.accounts.set_password(name, asked.password)
    if asked.sign_in is not None:
        laboratory.accounts.set_sign_in(name, asked.sign_in.strip() or None)
    laboratory.forget()
    guests: Guests = request.app.state.guests
    guests.out(name, but=guests.cookie_of(request.headers))
    return _people(request)


@router.get("/settings")
def settings(request: Request) -> wire.SettingsInfo:
    """How the record is kept."""
    found = records(request).settings()
    return wire.SettingsInfo(four_eyes=found["four-eyes"] == "yes", numbers=found["numbers"])


@router.post("/settings", status_code=201)
def set_to(request: Request, asked: wire.SettingsAsked) -> wire.SettingsInfo:
    """What is said counts from now on."""
    record = records(request)
    if asked.numbers is not None:
        record.set("numbers", asked.numbers)
    if asked.four_eyes is not None:
        record.set("four-eyes", "yes" if asked.four_eyes else "no")
    return settings(request)


def _needed(request: Request) -> LaboratoryEntrance:
    found = laboratory_of(request)
    if found is None:
        raise NotThereError("accounts: there are none on one's own machine. Serve a laboratory: --laboratory FILE.")
    return found


def _people(request: Request) -> wire.People:
    laboratory = laboratory_of(request)
    accounts = {} if laboratory is None else laboratory.accounts.all()
    found = []
    for name, roles in records(request).people().items():
        account = accounts.get(name)
        typed: list[Any] = list(roles)
        found.append(
            wire.PersonInfo(
                name=name,
                roles=typed,
                password=account is not None and account.password is not None,
                sign_in=None if account is None else account.sign_in,
            )
        )
    return wire.People(people=found)
