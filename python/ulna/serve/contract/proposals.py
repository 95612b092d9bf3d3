"""Certificates that wait for a second person."""

from __future__ import annotations

from typing import Literal

from ulna.serve.contract.filing import IssueAsked
from ulna.serve.contract.model import Asked, Name, Said, Sha256
from ulna.serve.contract.records import Long


class Proposal(Said):
    """One."""

    id: Name
    by: Name
    """Who proposed it."""
    at: str
    """When, UTC."""
    asked: IssueAsked
    state: Literal["waiting", "issued", "declined"]
    number: str | None
    """Of the certificate that it became."""
    decided_by: Name | None
    reason: str | None
    """Why it was declined."""
    sha256: Sha256 | None
    """The certificate, on the desk."""
    mine: bool
    """Whether whoever asks proposed it, and so may not approve it where four eyes are needed."""


class Proposals(Said):
    """The newest first."""

    proposals: list[Proposal]


class DeclineAsked(Asked):
    """No, and why."""

    reason: Long
