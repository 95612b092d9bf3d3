"""Who may do what: a row for each request that changes anything. What has no row, nobody may.

Whoever is signed in may look at everything but what `LOOKS` names.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from ulna.serve.people import Role

PREFIX = "/api/v1"
SAFE = ("GET", "HEAD", "OPTIONS")
OPEN = ("/login", "/about", "/provider/begin", "/provider/back")
"""Of the API what anybody may ask."""


@dataclass(frozen=True)
class Right:
    """What is asked for, and the role that it takes."""

    path: str
    """As the contract has it, below `PREFIX`."""
    role: Role
    method: str = "POST"


RIGHTS = (
    Right("/logout", "reader"),
    Right("/me/password", "reader"),
    Right("/compare", "reader"),
    Right("/arms/{sha256}/bodies", "reader"),
    Right("/play", "operator"),
    Right("/files", "operator"),
    Right("/sources/guess", "operator"),
    Right("/tables/look", "operator"),
    Right("/studies", "operator"),
    Right("/plans", "operator"),
    Right("/tests", "operator"),
    Right("/tests/play", "operator"),
    Right("/activities", "operator"),
    Right("/activities/{name}/do", "operator"),
    Right("/jobs", "operator"),
    Right("/jobs/{name}/cancel", "operator"),
    Right("/records/add", "operator"),
    Right("/records/equipment", "operator"),
    Right("/records/equipment/{name}/events", "operator"),
    Right("/records/proposals", "operator"),
    Right("/records/certify", "reviewer"),
    Right("/records/withdraw", "reviewer"),
    Right("/records/issue", "reviewer"),
    Right("/records/equipment/{name}/interval", "reviewer"),
    Right("/records/proposals/{name}/approve", "reviewer"),
    Right("/records/proposals/{name}/decline", "reviewer"),
    Right("/people", "admin"),
    Right("/people/{name}/account", "admin"),
    Right("/settings", "admin"),
)
LOOKS = (Right("/people", "admin", "GET"),)


def needed(method: str, path: str) -> Role | None:
    """The role that a request takes; None: nobody has it. path: below `PREFIX`."""
    rows = LOOKS if method in SAFE else RIGHTS
    found = next((row.role for row in rows if _matches(row, method, path)), None)
    return "reader" if found is None and method in SAFE else found


def _matches(row: Right, method: str, path: str) -> bool:
    return row.method == method and re.fullmatch(re.sub(r"\\\{\w+\\\}", "[^/]+", re.escape(row.path)), path) is not None
