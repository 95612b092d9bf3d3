"""One act of the record, as a text that is the same for the same act, and its hash: the links of the chain."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ulna.records.store import is_name, sha256_of

FORMAT = "ulna-entry/1"
FIRST = ""
"""What the first entry names as its previous one."""


@dataclass(frozen=True)
class Entry:
    """Who did what, when, to what; which files belong to it."""

    seq: int
    """From 1, without a gap."""
    at: str
    """When it was written, ISO 8601, UTC."""
    actor: str
    act: str
    """One of `ulna.records.acts.registry`."""
    subject: str
    """The equipment, certificate or person that it is about."""
    stated: Mapping[str, Any] = field(default_factory=dict)
    """What was said, as JSON."""
    files: Mapping[str, str] = field(default_factory=dict)
    """What a file is to the act → its SHA-256 in the store."""
    previous: str = FIRST
    """SHA-256 of the entry before."""

    @property
    def text(self) -> str:
        """The same for the same act."""
        document = {"format": FORMAT, **asdict(self)}
        return json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)

    @property
    def sha256(self) -> str:
        """Of its text in UTF-8: its name."""
        return sha256_of(self.text.encode())

    @classmethod
    def of_text(cls, text: str) -> Entry:
        """As written. Raises ValueError for a text that is no entry."""
        try:
            document = json.loads(text)
            if not isinstance(document, dict) or document.pop("format", None) != FORMAT:
                raise ValueError("no entry")
            entry = cls(**document)
        except (TypeError, RecursionError) as error:
            raise ValueError(str(error)) from None
        if wrong := entry.wrong():
            raise ValueError(f"its {wrong} is none")
        return entry

    def wrong(self) -> str | None:
        """Which of its parts is not what it must be; None where all are. No file but one by its SHA-256 is ever looked
        for."""
        if type(self.seq) is not int or self.seq < 1:
            return "seq"
        texts = ("at", "actor", "act", "subject", "previous")
        if (text := next((name for name in texts if not isinstance(getattr(self, name), str)), None)) is not None:
            return text
        if not isinstance(self.stated, dict):
            return "stated"
        if not isinstance(self.files, dict) or not all(isinstance(v, str) and is_name(v) for v in self.files.values()):
            return "files"
        return None
