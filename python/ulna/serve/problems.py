"""Errors as RFC 9457 has them, with the command line's words."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from ulna.ground.errors import UlnaInputError, for_people
from ulna.ground.worded import kept, worded
from ulna.serve.contract.model import Problem, Wording, shortened
from ulna.serve.places import without_places

MEDIA = "application/problem+json"
TITLES = {
    400: "This cannot be used",
    401: "Sign in first",
    403: "This is not allowed",
    404: "There is no such thing",
    405: "This is not done here",
    409: "This does not go now",
    413: "This is too large",
    422: "This cannot be used",
    429: "This was tried too often",
    500: "This is a fault of Ulna's",
}
FAULT = worded("This is a fault of Ulna's, please report it; nothing was written.")


class NotThereError(UlnaInputError):
    """What is asked for by name, and is not there."""


class NotNowError(UlnaInputError):
    """What cannot be done as things stand."""


class NotAllowedError(UlnaInputError):
    """What is not theirs to do."""


class NotLetInError(UlnaInputError):
    """Whoever this is, they are not who they say."""


class ProviderError(UlnaInputError):
    """Of a provider that cannot be reached, or said what is not to be believed."""


class TooOftenError(UlnaInputError):
    """It was tried too often; later it can be tried again."""


def problem(status: int, detail: str) -> Problem:
    """One."""
    said = shortened(for_people(without_places(detail)))
    return Problem(title=TITLES.get(status, "This did not go"), status=status, detail=str(said), said=Wording.of(said))


def answer(status: int, detail: str) -> JSONResponse:
    """The same as a response."""
    return JSONResponse(problem(status, detail).model_dump(), status, media_type=MEDIA)


def status_of(error: UlnaInputError) -> int:
    """Of what a user can cause."""
    return next((status for kind, status in _STATUSES if isinstance(error, kind)), 400)


_STATUSES: tuple[tuple[type[UlnaInputError], int], ...] = (
    (NotThereError, 404),
    (NotNowError, 409),
    (NotAllowedError, 403),
    (NotLetInError, 401),
    (TooOftenError, 429),
)


def install(app: FastAPI) -> None:
    """All that can go wrong in a route ends in one of these."""
    handlers: dict[type[Exception], Callable[[Request, Exception], Awaitable[JSONResponse]]] = {
        UlnaInputError: _said,
        RequestValidationError: _wrong,
        HTTPException: _refused,
        Exception: _fault,
    }
    for kind, handler in handlers.items():
        app.add_exception_handler(kind, handler)


async def _said(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, UlnaInputError)
    return answer(status_of(error), kept(error))


async def _wrong(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"])
    got = repr(first.get("input"))[:80]
    return answer(422, f"{where}: got {got}; {first['msg'][:1].lower()}{first['msg'][1:]}. Correct it.")


async def _refused(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    return answer(error.status_code, str(error.detail))


async def _fault(_: Request, error: Exception) -> JSONResponse:
    return answer(500, worded("{fault} ({kind})", fault=FAULT, kind=type(error).__name__))
