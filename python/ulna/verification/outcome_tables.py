"""What an acceptance test found, as the tables of verification.json. Lengths mm."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from ulna.ground.version import VERSION
from ulna.verification.decision import DecisionRule, Verdict
from ulna.verification.file import VerifyPlan
from ulna.verification.outcome import FigureResult, Judged, StateResult, TestResult
from ulna.verification.result_file import (
    FORMAT,
    ContributorTable,
    EnvironmentTable,
    FigureTable,
    GlobalRiskTable,
    ProcessTable,
    ProvenanceTable,
    RiskTable,
    SourceTable,
    StandingTable,
    StateTable,
    TemperatureTable,
    TermsTable,
    TestedTable,
    TouchesTable,
    UsedDecision,
    UsedProfile,
    ValueTable,
    VerificationFile,
)
from ulna.verification.risk import Risk


def verification_file(
    plan: VerifyPlan,
    arm: str,
    rule: DecisionRule,
    states: Sequence[StateResult],
    verdict: Verdict | None,
    time: datetime,
) -> VerificationFile:
    """All of it; arm: what reports call it."""
    profile = plan.profile
    temperature, bench = plan.file.temperature, plan.bench
    fixture_mm = bench.surroundings.fixture_mm
    return VerificationFile(
        format=FORMAT,
        arm=arm,
        verdict=verdict,
        profile=UsedProfile(
            name=profile.file.name,
            standard=profile.file.standard,
            statement=profile.file.statement,
            path=str(profile.path),
            sha256=profile.sha256,
        ),
        decision=UsedDecision(rule=rule.rule, text=rule.text, k=rule.k, p=rule.p, r=rule.part_of_expanded),
        scanner=plan.file.scanner,
        environment=EnvironmentTable(
            temperature=None if temperature is None else TemperatureTable(value=temperature.value, u=temperature.u),
            fixture=None if fixture_mm is None else StandingTable(u=fixture_mm),
            range=bench.range_mm,
        ),
        artefacts=[{"name": name, **table.in_mm(bench.mm)} for name, table in plan.file.artefact.items()],
        states=[_state(state) for state in states],
        provenance=ProvenanceTable(
            program="ulna",
            version=VERSION,
            plan=SourceTable(path=str(plan.path), sha256=plan.sha256),
            arms=[SourceTable(path=str(each.path), sha256=each.sha256) for each in plan.arms],
            files=[
                TouchesTable(
                    state=state,
                    path=str(each.path),
                    sha256=each.sha256,
                    rows=len(each.row),
                    points=each.source,
                    arm_sha256=each.arm_sha256,
                )
                for state, parts in plan.touches.items()
                for each in parts
            ],
            warnings=list(plan.warnings),
            time=time.isoformat(timespec="seconds"),
        ),
    )


def _state(found: StateResult) -> StateTable:
    """All tests in one state of the arm."""
    return StateTable(
        state=found.state,
        verdict=found.verdict,
        departures=found.departures,
        tests=[_test(test) for test in found.tests],
    )


def _test(found: TestResult) -> TestedTable:
    return TestedTable(
        name=found.name,
        kind=found.kind,
        readings=found.readings,
        verdict=found.verdict,
        departures=found.departures,
        figures=[_figure(figure) for figure in found.figures],
    )


def _figure(found: FigureResult) -> FigureTable:
    worst, definition, limit = found.worst, found.definition, found.limit
    budget = worst.single.budget
    return FigureTable(
        name=definition.name,
        key=definition.key,
        formula=definition.formula,
        standard=definition.standard,
        unit=definition.unit,
        value=worst.single.value_mm,
        of=worst.single.labels.as_dict(),
        limit=worst.limit_mm,
        limit_formula=None if limit is None else limit.text,
        limit_terms=None if limit is None else TermsTable(a=limit.a_mm, b=limit.b),
        u=budget.u_mm,
        k=found.k,
        p=found.p,
        expanded=None if budget.u_mm is None else found.k * budget.u_mm,
        guard=worst.decided.guard_mm,
        verdict=found.verdict,
        why=worst.decided.why,
        risk=None if found.risk is None else risk_table(found.risk),
        budget=[ContributorTable(name=each.name, u=each.u_mm, formula=each.formula) for each in budget.contributors],
        left_out=budget.left_out,
        individual=[_value(judged) for judged in found.values],
    )


def risk_table(found: Risk) -> RiskTable:
    """What a decision risks."""
    made, of_all = found.process, found.of_all
    shares = None
    if made is not None and of_all is not None:
        process = ProcessTable(mean=made.mean, deviation=made.deviation, distribution=made.distribution)
        shares = GlobalRiskTable(
            process=process,
            consumer=of_all.consumer,
            producer=of_all.producer,
            withheld=of_all.withheld,
            undecided=of_all.undecided,
        )
    return RiskTable(
        sides=found.sides,
        conformity=found.conformity,
        specific=found.specific,
        consumer_at_most=found.consumer_at_most,
        producer_at_most=found.producer_at_most,
        of_all=shares,
    )


def _value(judged: Judged) -> ValueTable:
    """Labels and sizes that a value does not have are left out, not null."""
    single = judged.single
    sizes = {"calibrated": single.calibrated_mm, "measured": single.measured_mm}
    return ValueTable.model_validate(
        {
            **single.labels.as_dict(),
            **{name: size for name, size in sizes.items() if size is not None},
            "value": single.value_mm,
            "limit": judged.limit_mm,
            "u": single.budget.u_mm,
            "guard": judged.decided.guard_mm,
            "verdict": judged.decided.verdict,
            "conformity": judged.conformity,
        }
    )
