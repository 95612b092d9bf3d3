"""Who may ask: an ASGI layer around everything.

Against rebinding, Host must be one of ours; against other sites' posts and sockets, Origin must be our own; whoever is
not signed in gets the page and nothing else, and who is gets what their roles allow. Nothing of other origins is loaded
by the page, nothing of it is framed.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass
from typing import Any

from fastapi.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, listed, recalled, templates, worded
from ulna.serve.entrance import Entrance
from ulna.serve.guests import Guests
from ulna.serve.people import Person
from ulna.serve.problems import answer, status_of
from ulna.serve.rights import OPEN, PREFIX, SAFE, needed

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]
Refused = tuple[int, str]

WHO = "ulna.who"
"""In a scope: the `Person` who asks."""
ADDRESS = "ulna.address"
"""In a scope: of whose machine."""
ROLES = templates("reader", "operator", "reviewer", "admin")
MOST_BODY, MOST_WORDS = 300 << 20, 1 << 20
"""Bytes that are taken: of a file, and of all else, also where nobody said before how many come."""
FILES = "/api/v1/files"
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
BY_TLS = (b"strict-transport-security", b"max-age=31536000")


@dataclass(frozen=True)
class Reach:
    """From where a server is reached."""

    hosts: frozenset[str]
    """As a browser names us, "127.0.0.1:8000"."""
    schemes: tuple[str, ...] = ("http", "https")
    """Of the page."""
    proxies: frozenset[str] | None = None
    """Addresses of the proxies before us: nobody else is answered, and they say who asks; None: there is none."""


class Guard:
    """The layer."""

    def __init__(self, app: App, guests: Guests, entrance: Entrance, reach: Reach) -> None:
        self.guests = guests
        self._app, self._entrance, self._reach = app, entrance, reach

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        refused = self._from_elsewhere(scope, headers) or await self._not_theirs(scope, headers)
        sent = _with_headers(send, scope["path"], self._reach.schemes == ("https",))
        if refused is None:
            await self._app(scope, _limited(receive, scope), sent)
        else:
            if scope["type"] == "websocket":
                await receive()
            await answer(*refused)(scope, receive, sent)

    def _from_elsewhere(self, scope: Scope, headers: dict[str, str]) -> Refused | None:
        peer = (scope.get("client") or ("", 0))[0]
        if self._reach.proxies is not None:
            if peer not in self._reach.proxies:
                return 403, f"address: got {peer}; expected one of the proxy's. Use the laboratory's address."
            if headers.get("x-forwarded-proto", "").split(",")[-1].strip().lower() not in ("https", "wss"):
                return 403, "X-Forwarded-Proto: expected https, said by the proxy. Use https, and let it say so."
            peer = headers.get("x-forwarded-for", peer).split(",")[-1].strip()[:60]
        scope[ADDRESS] = peer
        host, origin, path = headers.get("host", ""), headers.get("origin"), scope["path"]
        hosts = self._reach.hosts
        if host not in hosts:
            return 403, f"Host: got '{host[:80]}'; expected one of {', '.join(sorted(hosts))}. Use that address."
        unsafe = scope["type"] == "websocket" or scope["method"] not in SAFE
        if (unsafe or origin is not None) and origin not in {f"{scheme}://{host}" for scheme in self._reach.schemes}:
            return 403, f"Origin: got '{(origin or '')[:80]}'; expected this server's own. Use its page."
        said = headers.get("content-length", "0")
        if said.isdigit() and int(said) > _most(path):
            return 413, worded("{count} bytes; expected {most} at most. Cut it.", count=said, most=_most(path))
        return None

    async def _not_theirs(self, scope: Scope, headers: dict[str, str]) -> Refused | None:
        path = scope["path"]
        if not path.startswith(f"{PREFIX}/"):
            return None
        below = path.removeprefix(PREFIX)
        name = self.guests.known(self.guests.cookie_of(headers))
        try:
            who: Person | None = None if name is None else await run_in_threadpool(self._entrance.person, name)
        except UlnaInputError as error:
            return status_of(error), kept(error)
        scope[WHO] = who
        if below in OPEN:
            return None
        if who is None:
            return 401, self._entrance.closed
        role = needed(scope.get("method", "GET"), below)
        if role is not None and who.may(role):
            return None
        if role is None:
            return 405, worded(
                "{method} {path}: this is not done here. Use the page.", method=scope["method"], path=below[:80]
            )
        return 403, worded(
            "{name}: this is for who is {role}; you are {roles}. Ask an admin.",
            name=who.name,
            role=recalled(role, ROLES),
            roles=listed([recalled(each, ROLES) for each in sorted(who.roles)]),
        )


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


def _with_headers(send: Send, path: str, by_tls: bool) -> Send:
    policy = REPORT_POLICY if path.endswith("/report") else POLICY
    cached = b"public, max-age=31536000, immutable" if path.startswith("/assets/") else b"no-store"

    async def sent(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            own = {name for name, _ in message["headers"]}
            more = [*HEADERS, (b"content-security-policy", policy.encode()), (b"cache-control", cached)]
            more += [BY_TLS] if by_tls else []
            message["headers"] = [*message["headers"], *(pair for pair in more if pair[0] not in own)]
        await send(message)

    return sent
