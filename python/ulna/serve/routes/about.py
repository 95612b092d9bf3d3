"""Who speaks, and signing in."""

from __future__ import annotations

from fastapi import APIRouter, HTTPException, Request, Response

from ulna.documents.languages.languages import LANGUAGES
from ulna.ground.version import VERSION
from ulna.serve.contract.about import About, Login, Me, Play
from ulna.serve.guarding import SESSION_S, Guests
from ulna.serve.play import play
from ulna.serve.routes.common import workshop

router = APIRouter(tags=["about"])


@router.get("/about")
def about(request: Request) -> About:
    """The program and its bench."""
    bench = workshop(request).records.bench
    return About(
        version=VERSION,
        contract=request.app.state.contract,
        bench=workshop(request).folder.name,
        database="sqlite" if bench.database.sqlite else "postgresql",
        mode="local",
        languages=list(LANGUAGES),
    )


@router.post("/login")
def login(request: Request, response: Response, asked: Login) -> Me:
    """With the token of the address that was printed; a cookie that no script can read."""
    guests: Guests = request.app.state.guests
    cookie = guests.enter(asked.token)
    if cookie is None:
        raise HTTPException(401, "token: it is not this server's. Open the address that `ulna workbench` printed.")
    age_s, name = int(SESSION_S), guests.cookie_name
    response.set_cookie(name, cookie, max_age=age_s, httponly=True, samesite="strict", path="/")
    return _me(request)


@router.post("/logout", status_code=204)
def logout(request: Request, response: Response) -> None:
    """This browser's cookie is worth nothing any more."""
    guests: Guests = request.app.state.guests
    cookie = guests.cookie_of(request.headers)
    if cookie is not None:
        guests.leave(cookie)
    response.delete_cookie(guests.cookie_name, path="/")


@router.get("/me")
def me(request: Request) -> Me:
    """Who is signed in."""
    return _me(request)


@router.post("/play")
def virtual(request: Request) -> Play:
    """A virtual arm, its drawing and a plan, put on the desk."""
    return play(workshop(request).desk)


def _me(request: Request) -> Me:
    return Me(name=workshop(request).records.bench.by, roles=["operator", "reviewer", "admin"])
