"""Who may ask: an ASGI layer around everything.

Against rebinding, Host must be one of ours; against other sites' posts and sockets, Origin must be our own; whoever is
not signed in gets the page and nothing else. Nothing of other origins is loaded by the page, nothing of it is framed.
"""

from __future__ import annotations

import hmac
import secrets
import time
from collections.abc import Awaitable, Callable, Mapping, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any

from starlette.exceptions import HTTPException

from ulna.serve.problems import answer

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

SESSION_S = 12 * 3600.0
MOST_BODY, MOST_WORDS = 300 << 20, 1 << 20
"""Bytes that are taken: of a file, and of all else, also where nobody said before how many come."""
FILES = "/api/v1/files"
SAFE = ("GET", "HEAD", "OPTIONS")
OPEN = ("/api/v1/login", "/api/v1/about")
"""Of the API what anybody may ask."""
POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self'; script-src 'self'; object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'; connect-src 'self'"
)
REPORT_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:; "
    "font-src data:; connect-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'; "
    "sandbox allow-scripts"
)
"""Of a report in a frame: its own scripts run, in an origin of their own, and reach nothing."""
HEADERS = (
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
)


class Guests:
    """Who is signed in: by a token that is known to whoever started the server, then by a cookie."""

    def __init__(self, port: int, token: str | None = None) -> None:
        """port: where the server listens; a browser's cookies do not know it, and two servers must not share one."""
        self.token = token or secrets.token_urlsafe(24)
        self.cookie_name = f"ulna-session-{port}"
        self._until: dict[str, float] = {}

    def enter(self, token: str) -> str | None:
        """The cookie of whoever knows the token; None of others."""
        if not hmac.compare_digest(token.encode(), self.token.encode()):
            return None
        now = time.monotonic()
        self._until = {each: until for each, until in self._until.items() if until > now}
        cookie = secrets.token_urlsafe(32)
        self._until[cookie] = now + SESSION_S
        return cookie

    def leave(self, cookie: str) -> None:
        self._until.pop(cookie, None)

    def cookie_of(self, headers: Mapping[str, str]) -> str | None:
        """What a client carries."""
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self.cookie_name)
        except CookieError:
            return None
        return None if found is None else found.value

    def known(self, cookie: str | None) -> bool:
        """Whether somebody is signed in by it."""
        return cookie is not None and self._until.get(cookie, 0.0) > time.monotonic()


class Guard:
    """The layer."""

    def __init__(self, app: App, guests: Guests, hosts: frozenset[str]) -> None:
        """hosts: as a browser names us, "127.0.0.1:8000"."""
        self._app, self._guests, self._hosts = app, guests, hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        refused = self._refused(scope, headers)
        if refused is None:
            await self._app(scope, _limited(receive, scope), _with_headers(send, scope["path"]))
        else:
            if scope["type"] == "websocket":
                await receive()
            await answer(*refused)(scope, receive, _with_headers(send, scope["path"]))

    def _refused(self, scope: Scope, headers: dict[str, str]) -> tuple[int, str] | None:
        host, origin, path = headers.get("host", ""), headers.get("origin"), scope["path"]
        if host not in self._hosts:
            return 403, f"Host: got '{host[:80]}'; expected one of {', '.join(sorted(self._hosts))}. Use that address."
        unsafe = scope["type"] == "websocket" or scope["method"] not in SAFE
        if (unsafe or origin is not None) and origin not in {f"{scheme}://{host}" for scheme in ("http", "https")}:
            return 403, f"Origin: got '{(origin or '')[:80]}'; expected this server's own. Use its page."
        said = headers.get("content-length", "0")
        if said.isdigit() and int(said) > _most(path):
            return 413, f"{said} bytes; expected {_most(path)} at most. Cut it."
        if path.startswith("/api/") and path not in OPEN and not self._guests.known(self._guests.cookie_of(headers)):
            return 401, "Open the address that `ulna workbench` printed."
        return None


def _most(path: str) -> int:
    return MOST_BODY if path == FILES else MOST_WORDS


def _limited(receive: Receive, scope: Scope) -> Receive:
    most, count = _most(scope["path"]), 0

    async def received() -> MutableMapping[str, Any]:
        nonlocal count
        message = await receive()
        count += len(message.get("body", b"")) if message["type"] == "http.request" else 0
        if count > most:
            raise HTTPException(413, f"more than {most} bytes; expected fewer. Cut it.")
        return message

    return received


def _with_headers(send: Send, path: str) -> Send:
    policy = REPORT_POLICY if path.endswith("/report") else POLICY
    cached = b"public, max-age=31536000, immutable" if path.startswith("/assets/") else b"no-store"

    async def sent(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            own = {name for name, _ in message["headers"]}
            more = [*HEADERS, (b"content-security-policy", policy.encode()), (b"cache-control", cached)]
            message["headers"] = [*message["headers"], *(pair for pair in more if pair[0] not in own)]
        await send(message)

    return sent
