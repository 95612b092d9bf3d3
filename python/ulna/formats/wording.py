"""Rows and counts as messages name them."""

from __future__ import annotations

from ulna.ground.arrays import I64

SHOWN = 5
"""Rows named in a message."""


def rows_named(rows: I64) -> str:
    """`rows 3, 7, …`: the first few of (N,) row numbers."""
    named = ", ".join(str(row) for row in rows[:SHOWN].tolist())
    return f"row{'s' * (len(rows) > 1)} {named}{', …' if len(rows) > SHOWN else ''}"


def counted(count: int, noun: str) -> str:
    """`1 reading`, `2 readings`."""
    return f"{count} {noun}{'s' * (count > 1)}"
