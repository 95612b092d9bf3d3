"""Limits and how they decide, as files state them: maximum permissible errors and the rule of decision."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Tag

from ulna.formats.models import Strict, table_or_plain
from ulna.formats.numbers import Amount, Coverage, Positive

Rule = Literal["1.65u", "U", "rU", "simple"]


class LimitTable(Strict):
    """A limit that grows with the length: a + L / b."""

    a: Amount
    """A length."""
    b: Positive
    """No unit: 40000 is 25 µm for each metre."""


LimitValue = Annotated[
    Annotated[Positive, Tag("<plain>")] | Annotated[LimitTable, Tag("<table>")], Discriminator(table_or_plain)
]


class ProcessTable(Strict):
    """What is known of all arms of this kind before any is measured: how a figure's true values are spread."""

    mean: float
    """A length."""
    deviation: Positive
    """Standard deviation, a length."""


class DecisionTable(Strict):
    """When a value passes."""

    rule: Rule
    """Guard band w: "1.65u" (ISO 14253-1:2017), "U" (its older editions), "rU" (w = r U) or "simple" (none)."""
    r: Positive | None = None
    """Of the rule "rU": the guard band as a part of U."""
    k: Positive
    """Coverage factor of the expanded uncertainty U = k u."""
    p: Coverage
    """Its coverage probability."""
