"""How somebody comes in, and who that is. On one's own machine: by the token of the address that was printed."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Sequence
from typing import Literal, Protocol

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
    closed = "Open the address that `ulna workbench` printed."

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
                raise NotLetInError(f"token: it is not this server's. {self.closed}")
            case LoginPassword():
                raise NotLetInError(f"way: got 'password'; expected 'token'. {self.closed}")

    def person(self, name: str) -> Person | None:
        """Whoever knew the token."""
        return Person(name, ALL) if name == self._name else None
