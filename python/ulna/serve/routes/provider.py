"""Signing in at an OpenID provider: there, and back."""

from __future__ import annotations

import hmac
from typing import TYPE_CHECKING

from fastapi import APIRouter, Request, Response
from fastapi.responses import RedirectResponse

from ulna.serve.guarding import ADDRESS
from ulna.serve.guests import BEGUN_S, Guests
from ulna.serve.laboratory.entrance import LOG, LaboratoryEntrance
from ulna.serve.problems import NotLetInError, NotThereError, ProviderError
from ulna.serve.routes.about import admit, laboratory_of

if TYPE_CHECKING:
    from ulna.serve.laboratory.provider import Provider

router = APIRouter(prefix="/provider", tags=["about"])
REFUSED, SILENT, UNKNOWN = "/#sign-in=refused", "/#sign-in=silent", "/#sign-in=unknown"
"""Where a browser is sent that was not let in: the page says why."""


@router.get("/begin", response_class=Response, status_code=303, responses={303: {"description": "to the provider"}})
def begin(request: Request) -> Response:
    """To the provider; the browser keeps by which state it comes back."""
    _, provider = _needed(request)
    try:
        url, state = provider.begin()
    except ProviderError as error:
        LOG.warning("sign-in: %s", error)
        return RedirectResponse(SILENT, 303)
    answer = RedirectResponse(url, 303)
    guests: Guests = request.app.state.guests
    answer.set_cookie(
        _cookie(guests), state, max_age=int(BEGUN_S), httponly=True, samesite="lax", secure=guests.secure, path="/"
    )
    return answer


@router.get("/back", response_class=Response, status_code=303, responses={303: {"description": "to the page"}})
def back(request: Request) -> Response:
    """From the provider, who says who it is."""
    laboratory, provider = _needed(request)
    guests: Guests = request.app.state.guests
    kept, state = request.cookies.get(_cookie(guests), ""), request.query_params.get("state", "")
    if not (state and hmac.compare_digest(kept.encode(), state.encode())):
        return RedirectResponse(REFUSED, 303)
    try:
        name = laboratory.from_provider(provider.finish(state, request.url.query), request.scope[ADDRESS])
    except ProviderError as error:
        LOG.warning("sign-in refused: from %s, %s", request.scope[ADDRESS], error)
        answer: Response = RedirectResponse(REFUSED, 303)
    except NotLetInError:
        answer = RedirectResponse(UNKNOWN, 303)
    else:
        answer = RedirectResponse("/", 303)
        admit(request, answer, name)
    answer.delete_cookie(_cookie(guests), path="/", secure=guests.secure)
    return answer


def _cookie(guests: Guests) -> str:
    return f"{guests.cookie_name}-state"


def _needed(request: Request) -> tuple[LaboratoryEntrance, Provider]:
    laboratory = laboratory_of(request)
    if laboratory is None or laboratory.provider is None:
        raise NotThereError("provider: there is none here. Sign in otherwise.")
    return laboratory, laboratory.provider
