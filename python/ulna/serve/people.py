"""Who works here, and in which roles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Role = Literal["reader", "operator", "reviewer", "admin"]
ALL: frozenset[str] = frozenset(("reader", "operator", "reviewer", "admin"))


@dataclass(frozen=True)
class Person:
    """Somebody who is signed in."""

    name: str
    """As the record has it."""
    roles: frozenset[str]
    """Whoever is signed in reads."""

    def may(self, role: str) -> bool:
        """Whether what needs a role is theirs to do."""
        return role == "reader" or role in self.roles
