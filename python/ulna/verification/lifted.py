"""Uncertainties of test values that are too small to be stated, lifted; and what is decided with them. Lengths mm.

An accredited laboratory states no expanded uncertainty below its calibration and measurement capability, CMC
(ILAC-P14:09/2020, 5.4). Where U is lifted, the guard band, the verdict and its risks follow: a decision with an
uncertainty other than the stated one would be nobody's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ulna.ground.digits import two_digits_up
from ulna.verification.decision import DecisionRule, Limit, severity, worst_verdict
from ulna.verification.outcome_tables import risk_table
from ulna.verification.result_file import (
    ContributorTable,
    FigureTable,
    RiskTable,
    StateTable,
    TestedTable,
    UsedDecision,
    ValueTable,
    VerificationFile,
)
from ulna.verification.risk import Decision, Process, conformity_of, risk_of
from ulna.verification.tables import State

LIFTED = "lifted to the CMC"


@dataclass(frozen=True)
class Lifted:
    """A figure with values whose U was too small."""

    state: State
    figure: str
    """Its name."""
    key: str
    values: int
    """How many of them."""
    computed_mm: float | None
    """U of its worst value as it was computed; None where that value's U is large enough."""
    stated_mm: float | None
    """What stands in its place."""


def rule_of(used: UsedDecision) -> DecisionRule:
    """The rule that a verification was decided by."""
    return DecisionRule(used.rule, used.k, used.p, used.r if used.rule == "rU" else None)


def lifted(file: VerificationFile, least: Mapping[str, Limit]) -> tuple[VerificationFile, list[Lifted]]:
    """The same with no U below `least`, by the short name of a figure, each rounded up to two digits as U is; and what
    was lifted. A value whose uncertainty is not known stays so."""
    told: list[Lifted] = []
    rule = rule_of(file.decision)

    def state(found: StateTable) -> StateTable:
        tests = [test(each, found.state) for each in found.tests]
        return found.model_copy(update={"tests": tests, "verdict": worst_verdict([each.verdict for each in tests])})

    def test(found: TestedTable, of: State) -> TestedTable:
        figures = [figure(each, of) for each in found.figures]
        return found.model_copy(
            update={"figures": figures, "verdict": worst_verdict([each.verdict for each in figures])}
        )

    def figure(found: FigureTable, of: State) -> FigureTable:
        if found.key not in least:
            return found
        made, count = _figure(found, rule, least[found.key])
        if count:
            same = made.u == found.u
            told.append(
                Lifted(
                    of, found.name, found.key, count, None if same else found.expanded, None if same else made.expanded
                )
            )
        return made

    states = [state(each) for each in file.states]
    if not told:
        return file, []
    verdict = worst_verdict([each.verdict for each in states])
    return file.model_copy(update={"states": states, "verdict": verdict}), told


def _figure(found: FigureTable, rule: DecisionRule, least: Limit) -> tuple[FigureTable, int]:
    """With its values lifted, and how many were; its worst value may be another one then."""
    shared = found.model_dump(include={"value", "limit", "u", "guard", "verdict"})
    own = ValueTable.model_validate({**found.of, **shared})
    before = found.individual or [own]
    signed = found.risk is None or found.risk.sides == "two-sided"
    after = [_value(each, rule, found.k, least, signed) for each in before]
    count = sum(new is not old for new, old in zip(after, before, strict=True))
    if not count:
        return found, 0
    at = max(range(len(after)), key=lambda k: severity(after[k].verdict, after[k].value, after[k].limit))
    worst, was = after[at], before[at]
    change = {
        "value": worst.value,
        "of": {key: text for key in found.of if (text := getattr(worst, key)) is not None},
        "limit": worst.limit,
        "u": worst.u,
        "expanded": None if worst.u is None else found.k * worst.u,
        "guard": worst.guard,
        "verdict": worst.verdict,
        "risk": _risk(found.risk, worst, signed),
        "budget": _budget(found, worst, was),
        "individual": after if found.individual else [],
    }
    return found.model_copy(update=change), count


def _value(value: ValueTable, rule: DecisionRule, k: float, least: Limit, signed: bool) -> ValueTable:
    """The same object where its U is large enough."""
    bound = two_digits_up(least.at_mm(value.calibrated))
    if value.u is None or k * value.u >= bound:
        return value
    u = bound / k
    decided = rule.decide(value.value, value.limit, u)
    conformity = conformity_of(value.value, u, value.limit, signed)
    change = {"u": u, "guard": decided.guard_mm, "verdict": decided.verdict, "conformity": conformity}
    return value.model_copy(update=change)


def _budget(found: FigureTable, worst: ValueTable, was: ValueTable) -> list[ContributorTable]:
    """Its squares add up to u² as before; of another value than before the contributors are not known."""
    if worst.u == was.u and was.value == found.value:
        return found.budget
    known = found.budget if was.value == found.value and was.u == found.u else []
    rest = (worst.u or 0.0) ** 2 - sum(each.u**2 for each in known)
    return [*known, ContributorTable(name=LIFTED, u=math.sqrt(max(rest, 0.0)), formula="√(CMC² / k² - u²)")]


def _risk(found: RiskTable | None, worst: ValueTable, signed: bool) -> RiskTable | None:
    if found is None or worst.u is None or worst.limit is None or worst.guard is None:
        return None
    process = None
    if found.of_all is not None:
        process = Process(found.of_all.process.mean, found.of_all.process.deviation)
    decision = Decision(worst.value, worst.u, worst.limit, worst.guard, worst.verdict)
    return risk_table(risk_of(decision, signed, process))
