"""Certificates that somebody proposed: another person looks at each, and issues it or says why not.

The record hears of one when it is issued; until then it is a file of the bench.
"""

from __future__ import annotations

import secrets
import threading
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from ulna.formats.output import write_file
from ulna.ground.worded import recalled, templates, worded
from ulna.records.records import Records
from ulna.serve.contract.filing import IssueAsked, IssuedNow
from ulna.serve.contract.proposals import Proposal
from ulna.serve.problems import NotNowError, NotThereError

STATES = templates("issued", "declined")
"""What became of one."""


class _Kept(BaseModel):
    """One, as its file has it."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    by: str
    at: str
    asked: IssueAsked
    state: str = "waiting"
    number: str | None = None
    decided_by: str | None = None
    reason: str | None = None
    sha256: str | None = None


class Proposals:
    """Of one bench."""

    def __init__(self, folder: Path, issue: Callable[[Records, IssueAsked], IssuedNow]) -> None:
        """folder: a file each. issue: makes one a certificate."""
        self._folder, self._issue = folder, issue
        self._lock = threading.Lock()

    def all(self, who: str) -> list[Proposal]:
        """The newest first, as somebody sees them; what cannot be read stays where it is."""
        found = []
        for path in self._folder.glob("*.json"):
            try:
                found.append(_said(path.stem, self._kept(path.stem), who))
            except NotThereError:
                continue
        return sorted(found, key=lambda each: each.id, reverse=True)

    def propose(self, asked: IssueAsked, who: str) -> Proposal:
        """One more."""
        now = datetime.now(UTC)
        name = f"{now:%Y-%m-%d-%H%M%S}-{secrets.token_hex(2)}"
        kept = _Kept(by=who, at=now.isoformat(timespec="seconds"), asked=asked.model_copy(update={"approved_by": None}))
        self._keep(name, kept)
        return _said(name, kept, who)

    def approve(self, name: str, who: str, records: Records) -> Proposal:
        """It is issued: the entry is the proposer's, with the name of whoever approves. Raises UlnaInputError where the
        record refuses it."""
        with self._lock:
            kept = self._waiting(name)
            alone = kept.by == who and records.settings()["four-eyes"] != "yes"
            asked = kept.asked.model_copy(update={"approved_by": None if alone else who})
            made = self._issue(records.worked_by(kept.by), asked)
            kept = kept.model_copy(
                update={"state": "issued", "number": made.number, "decided_by": who, "sha256": made.sha256}
            )
            self._keep(name, kept)
        return _said(name, kept, who)

    def decline(self, name: str, who: str, reason: str) -> Proposal:
        """It is not issued."""
        with self._lock:
            kept = self._waiting(name)
            kept = kept.model_copy(update={"state": "declined", "decided_by": who, "reason": reason})
            self._keep(name, kept)
        return _said(name, kept, who)

    def _waiting(self, name: str) -> _Kept:
        kept = self._kept(name)
        if kept.state != "waiting":
            raise NotNowError(
                worded(
                    "proposal '{name}': was {state} by {who}. Propose anew.",
                    name=name,
                    state=recalled(kept.state, STATES),
                    who=str(kept.decided_by),
                )
            )
        return kept

    def _kept(self, name: str) -> _Kept:
        path = self._folder / f"{name}.json"
        try:
            if path.parent != self._folder or path.name != f"{name}.json":
                raise FileNotFoundError
            return _Kept.model_validate_json(path.read_bytes())
        except (OSError, ValueError, ValidationError):
            raise NotThereError(worded("proposal '{name}': there is none. Propose one.", name=name[:80])) from None

    def _keep(self, name: str, kept: _Kept) -> None:
        write_file(self._folder / f"{name}.json", kept.model_dump_json(indent=1) + "\n", force=True)


def _said(name: str, kept: _Kept, who: str) -> Proposal:
    return Proposal(id=name, mine=kept.by == who, **dict(kept))
