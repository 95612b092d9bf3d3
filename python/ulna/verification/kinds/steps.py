"""What an operator does, touch by touch."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """One touch."""

    test: str
    artefact: str = ""
    """Name of one that the test wants; "" for a seat, which no certificate is about."""
    position: str = ""
    orientation: str = ""
    repeat: str = ""
    feature: str = ""
    what: str = ""
    """In words."""
