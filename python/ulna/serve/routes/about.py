"""Who speaks, and signing in."""

from __future__ import annotations

from typing import Annotated, Any, get_args

from fastapi import APIRouter, Body, Request, Response

from ulna.documents.languages.languages import LANGUAGES
from ulna.ground.version import VERSION
from ulna.serve.contract.about import About, Login, Me, PasswordAsked, Play
from ulna.serve.entrance import Entrance
from ulna.serve.guarding import ADDRESS
from ulna.serve.guests import Guests
from ulna.serve.laboratory.entrance import LaboratoryEntrance
from ulna.serve.people import Person, Role
from ulna.serve.play import play
from ulna.serve.problems import NotLetInError, NotThereError
from ulna.serve.routes.common import who, workshop

router = APIRouter(tags=["about"])


@router.get("/about")
def about(request: Request) -> About:
    """The program and its bench."""
    bench = workshop(request).records.bench
    entrance: Entrance = request.app.state.entrance
    laboratory = laboratory_of(request)
    return About(
        version=VERSION,
        contract=request.app.state.contract,
        bench=workshop(request).folder.name,
        database="sqlite" if bench.database.sqlite else "postgresql",
        mode="local" if laboratory is None else "laboratory",
        ways=list(entrance.ways),
        provider=None if laboratory is None or laboratory.provider is None else laboratory.provider.title,
        languages=list(LANGUAGES),
    )


@router.post("/login")
def login(request: Request, response: Response, asked: Annotated[Login, Body()]) -> Me:
    """With the token of the address that was printed, or with a name and its password; a cookie that no script can
    read."""
    entrance: Entrance = request.app.state.entrance
    name = entrance.enter(asked, request.scope[ADDRESS])
    found = entrance.person(name)
    if found is None:
        raise NotLetInError(entrance.closed)
    admit(request, response, name)
    return _me(request, found)


@router.post("/logout", status_code=204)
def logout(request: Request, response: Response) -> None:
    """This browser's cookie is worth nothing any more."""
    guests: Guests = request.app.state.guests
    cookie = guests.cookie_of(request.headers)
    if cookie is not None:
        guests.leave(cookie)
    response.delete_cookie(guests.cookie_name, path="/", secure=guests.secure)


@router.get("/me")
def me(request: Request) -> Me:
    """Who is signed in."""
    return _me(request, who(request))


@router.post("/me/password", status_code=204)
def password(request: Request, asked: PasswordAsked) -> None:
    """Another one; other browsers of theirs must sign in anew."""
    laboratory, name = laboratory_of(request), who(request).name
    if laboratory is None:
        raise NotThereError("password: there is none on one's own machine. Give none.")
    laboratory.change_password(name, asked.now, asked.new, request.scope[ADDRESS])
    guests: Guests = request.app.state.guests
    guests.out(name, but=guests.cookie_of(request.headers))


@router.post("/play")
def virtual(request: Request) -> Play:
    """A virtual arm, its drawing and a plan, put on the desk."""
    return play(workshop(request).desk)


def laboratory_of(request: Request) -> LaboratoryEntrance | None:
    """Where people sign in; None on one's own machine."""
    entrance = request.app.state.entrance
    return entrance if isinstance(entrance, LaboratoryEntrance) else None


def admit(request: Request, response: Response, name: str) -> None:
    """The cookie of somebody who proved who they are."""
    guests: Guests = request.app.state.guests
    response.set_cookie(
        guests.cookie_name,
        guests.admit(name),
        max_age=max(1, int(guests.session_s)),
        httponly=True,
        samesite="strict",
        secure=guests.secure,
        path="/",
    )


def _me(request: Request, found: Person) -> Me:
    laboratory = laboratory_of(request)
    roles: list[Any] = [role for role in get_args(Role) if found.may(role)]
    return Me(name=found.name, roles=roles, password=laboratory is not None and laboratory.has_password(found.name))
