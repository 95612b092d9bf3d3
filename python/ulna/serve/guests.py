"""Who is signed in: by a cookie that no script and no other site gets, for some hours."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Mapping
from http.cookies import CookieError, SimpleCookie

SESSION_S = 12 * 3600.0
BEGUN_S = 600.0
"""How long somebody may take at a provider."""


class Guests:
    """Of one server."""

    def __init__(self, port: int, secure: bool = False, session_s: float | None = None) -> None:
        """port: where the server listens; a browser's cookies do not know it, and two servers must not share one.
        secure: they go over TLS only."""
        self.secure = secure
        self.cookie_name = f"__Host-ulna-session-{port}" if secure else f"ulna-session-{port}"
        self.session_s = SESSION_S if session_s is None else session_s
        self._lock = threading.Lock()
        self._until: dict[str, tuple[str, float]] = {}

    def admit(self, name: str) -> str:
        """The cookie of somebody who proved who they are."""
        now_s, cookie = time.monotonic(), secrets.token_urlsafe(32)
        with self._lock:
            self._until = {each: found for each, found in self._until.items() if found[1] > now_s}
            self._until[cookie] = name, now_s + self.session_s
        return cookie

    def leave(self, cookie: str) -> None:
        """It is worth nothing any more."""
        with self._lock:
            self._until.pop(cookie, None)

    def out(self, name: str, but: str | None = None) -> None:
        """All of somebody's are worth nothing any more. but: one that stays."""
        with self._lock:
            self._until = {each: found for each, found in self._until.items() if found[0] != name or each == but}

    def cookie_of(self, headers: Mapping[str, str]) -> str | None:
        """What a client carries."""
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self.cookie_name)
        except CookieError:
            return None
        return None if found is None else found.value

    def known(self, cookie: str | None) -> str | None:
        """The name of whoever is signed in by it."""
        if cookie is None:
            return None
        with self._lock:
            name, until_s = self._until.get(cookie, ("", 0.0))
        return name if until_s > time.monotonic() else None
