"""When a test value passes, by ISO 14253-1: a guard band g about the limit. Lengths mm.

pass where |value| ≤ limit - g, fail where |value| > limit + g, else undecided; u is the uncertainty of the test value,
not of the arm. In the words of JCGM 106:2012, 8.3, and ILAC-G8:09/2019 the band is w = r U.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ulna.ground.worded import worded
from ulna.verification.departures import DECISION, GUARD_2017, GUARD_RU, GUARD_SIMPLE, GUARD_U, NO_LIMIT, NO_UNCERTAINTY
from ulna.verification.limits import Rule

Verdict = Literal["pass", "fail", "undecided"]


FACTOR_2017 = 1.65
"""Of u: 95 % probability of conformity at the limit of acceptance, one-sided, as ISO 14253-1:2017 has it."""


@dataclass(frozen=True)
class DecisionRule:
    """How a value is compared with its limit."""

    rule: Rule
    k: float
    p: float
    r: float | None = None
    """Of the rule "rU": the guard band as a part of U."""

    @property
    def part_of_expanded(self) -> float:
        """The r of w = r U."""
        parts: dict[Rule, float] = {"1.65u": FACTOR_2017 / self.k, "U": 1.0, "rU": self.r or 0.0, "simple": 0.0}
        return parts[self.rule]

    @property
    def text(self) -> str:
        """In words, for reports."""
        r = f"{self.part_of_expanded:.3g}"
        guard = {
            "1.65u": worded(GUARD_2017, factor=str(FACTOR_2017), r=r),
            "U": worded(GUARD_U, k=f"{self.k:g}"),
            "rU": worded(GUARD_RU, r=r, k=f"{self.k:g}"),
            "simple": worded(GUARD_SIMPLE),
        }[self.rule]
        return worded(DECISION, guard=guard)

    def guard_mm(self, u_mm: float | None) -> float | None:
        """The guard band; None where it needs an uncertainty that is not known."""
        if self.rule == "simple":
            return 0.0
        if u_mm is None:
            return None
        return (FACTOR_2017 if self.rule == "1.65u" else self.part_of_expanded * self.k) * u_mm

    def decide(self, value_mm: float, limit_mm: float | None, u_mm: float | None) -> Decided:
        """One value."""
        guard = self.guard_mm(u_mm)
        if limit_mm is None:
            return Decided(None, guard, NO_LIMIT)
        if guard is None:
            return Decided(None, None, NO_UNCERTAINTY)
        size = abs(value_mm)
        if size <= limit_mm - guard:
            return Decided("pass", guard)
        return Decided("fail" if size > limit_mm + guard else "undecided", guard)


@dataclass(frozen=True)
class Decided:
    """What the rule says of a value."""

    verdict: Verdict | None
    guard_mm: float | None
    why: str | None = None
    """Why there is no verdict."""


@dataclass(frozen=True)
class Limit:
    """A maximum permissible error: a + L / b."""

    a_mm: float
    b: float | None = None

    def at_mm(self, length_mm: float | None) -> float:
        """For a length; of a value that has none, a."""
        return self.a_mm + (0.0 if self.b is None or length_mm is None else length_mm / self.b)

    @property
    def text(self) -> str:
        """As a formula."""
        return f"{self.a_mm:g} mm" if self.b is None else f"{self.a_mm:g} mm + L / {self.b:g}"


def severity(verdict: Verdict | None, value_mm: float, limit_mm: float | None) -> tuple[int, float]:
    """What makes a value the worst of several: a fail before all, then what is nearest to its limit or farthest beyond
    it; without limits the largest."""
    size = abs(value_mm)
    order: dict[Verdict | None, int] = {"fail": 3, "undecided": 2, "pass": 1, None: 0}
    return order[verdict], size if limit_mm is None else size - limit_mm


def worst_verdict(verdicts: list[Verdict | None]) -> Verdict | None:
    """Of several: one that fails makes all fail; None where nothing is said of any."""
    ordered: tuple[Verdict, ...] = ("fail", "undecided", "pass")
    return next((verdict for verdict in ordered if verdict in verdicts), None)
