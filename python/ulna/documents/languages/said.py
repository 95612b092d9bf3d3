"""A sentence that is not yet in a language: its key and the values that fill it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Said:
    """One sentence: a key of the catalogue (`ulna.documents.languages`) and the values that fill it."""

    key: str
    values: dict[str, Any] = field(default_factory=dict)
    """Text and numbers, as they are; the catalogue rounds, the rendering escapes."""
