"""Limits and how they decide, as files state them: maximum permissible errors and the rule of decision."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Tag

from ulna.formats.models import Strict
from ulna.formats.numbers import Amount, Coverage, Positive

Rule = Literal["1.65u", "U", "simple"]


class LimitTable(Strict):
    """A limit that grows with the length: a + L / b."""

    a: Amount
    """A length."""
    b: Positive
    """No unit: 40000 is 25 µm for each metre."""


def _limit_kind(limit: Any) -> str:
    return "<grows>" if isinstance(limit, dict | LimitTable) else "<constant>"


LimitValue = Annotated[
    Annotated[Positive, Tag("<constant>")] | Annotated[LimitTable, Tag("<grows>")], Discriminator(_limit_kind)
]


class DecisionTable(Strict):
    """When a value passes."""

    rule: Rule
    """Guard band: "1.65u" (ISO 14253-1:2017), "U" (its older editions) or "simple" (none)."""
    k: Positive
    """Coverage factor of the expanded uncertainty U = k u."""
    p: Coverage
    """Its coverage probability."""
