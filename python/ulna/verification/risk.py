"""What a decision risks: of one value, of the rule, and of all arms that are made. Lengths mm.

Formulas are those of `conformity`. A figure that may be negative keeps its limit where it lies between -limit and
limit; one that may not, such as a form deviation, where it is not above it. The probability of conformity knows of the
value nothing but its measurement; what is stated of what is made goes into the global risk alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ulna.ground.errors import UlnaInputError
from ulna.verification.conformity import GlobalRisk, Made, global_risk, probability, risk
from ulna.verification.decision import Verdict
from ulna.verification.limits import ProcessTable

Sides = Literal["one-sided", "two-sided"]


@dataclass(frozen=True)
class Process:
    """What is made, as it was stated."""

    mean_mm: float
    deviation_mm: float

    @classmethod
    def of(cls, table: ProcessTable, mm: float, signed: bool, where: str) -> Process:
        """As a verify file states it; mm: in its unit; where: the key, for messages.

        Raises UlnaInputError where a figure that cannot be negative could not be spread so.
        """
        if not signed and not 0.0 < table.deviation <= table.mean:
            raise UlnaInputError(
                f"{where}: got mean = {table.mean:g} and deviation = {table.deviation:g}; this figure cannot be "
                "negative, and its values are taken to follow a gamma distribution: expected a mean above 0 and a "
                "deviation not above the mean. Correct them."
            )
        return cls(table.mean * mm, table.deviation * mm)

    def made(self, signed: bool) -> Made:
        """Its density: of a figure that cannot be negative a gamma distribution."""
        return Made(self.mean_mm, self.deviation_mm, "normal" if signed else "gamma")


@dataclass(frozen=True)
class Decision:
    """A value with its limit and what the rule said of it."""

    value_mm: float
    u_mm: float
    limit_mm: float
    guard_mm: float
    verdict: Verdict | None


@dataclass(frozen=True)
class Risk:
    """Of one decision, and of the rule that made it."""

    sides: Sides
    """Of the limit."""
    conformity: float
    """Probability that the true value keeps the limit."""
    specific: float | None
    """Risk that this verdict is wrong: of a pass the consumer's, 1 - conformity; of a fail the producer's, conformity.
    None where nothing was decided."""
    consumer_at_most: float | None
    """The rule's largest specific risk of the consumer: of a value that only just passes; None where none can."""
    producer_at_most: float
    """The rule's largest specific risk of the producer: of a value that only just fails."""
    process: Made | None
    """What is made; None where it was not stated."""
    of_all: GlobalRisk | None
    """Global risks, at this value's limit, uncertainty and guard band; None without a process."""


def bounds_mm(limit_mm: float, signed: bool) -> tuple[float, float]:
    """What is tolerated, from and to."""
    return (-limit_mm if signed else -math.inf), limit_mm


def conformity_of(value_mm: float, u_mm: float | None, limit_mm: float | None, signed: bool) -> float | None:
    """Probability that a true value keeps its limit; None where there is no limit or no uncertainty."""
    if u_mm is None or limit_mm is None:
        return None
    return probability(value_mm, u_mm, *bounds_mm(limit_mm, signed))


def risk_of(decision: Decision, signed: bool, process: Process | None) -> Risk:
    """Of a decision on a figure's value."""
    u_mm, limit_mm, guard_mm = decision.u_mm, decision.limit_mm, decision.guard_mm
    bounds = bounds_mm(limit_mm, signed)
    conformity = probability(decision.value_mm, u_mm, *bounds)
    wrong = {"pass": risk(decision.value_mm, u_mm, *bounds), "fail": conformity}
    made = None if process is None else process.made(signed)
    return Risk(
        sides="two-sided" if signed else "one-sided",
        conformity=conformity,
        specific=wrong.get(decision.verdict or ""),
        consumer_at_most=risk(limit_mm - guard_mm, u_mm, *bounds) if guard_mm <= limit_mm else None,
        # just above: on the bound itself nothing is decided, and an exact value would keep its limit there
        producer_at_most=probability(math.nextafter(limit_mm + guard_mm, math.inf), u_mm, *bounds),
        process=made,
        of_all=None if made is None else global_risk(made, u_mm, limit_mm, guard_mm),
    )
