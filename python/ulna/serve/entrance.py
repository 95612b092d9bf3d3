"""How somebody comes in, and who that is. On one's own machine: by the token of the address that was printed."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Sequence
from typing import Literal, Protocol

from ulna.ground.worded import worded
from ulna.serve.contract.about import Login, LoginPassword, LoginToken
from ulna.serve.people import ALL, Person
from ulna.serve.problems import NotLetInError

Way = Literal["token", "password", "provider"]


class Entrance(Protocol):
    """Of a server."""

    ways: Sequence[Way]
    closed: str
    """What whoever is not signed in is told to do."""

    def enter(self, asked: Login, address: str) -> str:
        """The name of whoever it is. address: of their machine. Raises NotLetInError, TooOftenError."""
        ...

    def person(self, name: str) -> Person | None:
        """As they stand now; None: gone."""
        ...


class OwnEntrance:
    """Of a server for one person on their own machine, who may do everything."""

    ways: Sequence[Way] = ("token",)
    closed = worded("Open the address that `ulna workbench` printed.")

    def __init__(self, name: str, token: str | None = None) -> None:
        """name: of who works."""
        self._name = name
        self.token = token or secrets.token_urlsafe(24)

    def enter(self, asked: Login, address: str) -> str:
        """By the token."""
        match asked:
            case LoginToken():
                if hmac.compare_digest(asked.token.encode(), self.token.encode()):
                    return self._name
                raise NotLetInError(worded("token: it is not this server's. {closed}", closed=self.closed))
            case LoginPassword():
                raise NotLetInError(worded("way: got 'password'; expected 'token'. {closed}", closed=self.closed))

    def person(self, name: str) -> Person | None:
        """Whoever knew the token."""
        return Person(name, ALL) if name == self._name else None
