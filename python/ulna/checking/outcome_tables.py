"""What a check found, as the tables of its file. Lengths mm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ulna.checking.history import Earlier
from ulna.checking.outcome import Advice, Checked
from ulna.checking.result_file import (
    AdviceTable,
    CheckedTable,
    CheckProvenance,
    EarlierTable,
    HistoryTable,
    SignalTable,
)
from ulna.checking.series import History
from ulna.verification.result_file import ContributorTable, VerificationFile


def of_verification(found: VerificationFile, history: Sequence[Earlier], remarks: Sequence[str]) -> dict[str, Any]:
    """What a check's file has in common with that of an acceptance test."""
    source = found.provenance
    return {
        "arm": found.arm,
        "decision": found.decision,
        "environment": found.environment,
        "artefacts": found.artefacts,
        "provenance": CheckProvenance(
            program=source.program,
            version=source.version,
            arms=source.arms,
            files=source.files,
            history=[EarlierTable(path=str(each.path), sha256=each.sha256, time=each.file.time) for each in history],
            warnings=list(remarks),
            time=source.time,
        ),
    }


def checked_table(found: Checked, k: float) -> CheckedTable:
    """k: of U = k u."""
    single, definition, decided = found.judged.single, found.definition, found.judged.decided
    u_mm = single.budget.u_mm
    return CheckedTable(
        test=found.test,
        kind=found.kind,
        key=definition.key,
        name=definition.name,
        formula=definition.formula,
        standard=definition.standard,
        signed=definition.signed,
        of=single.labels.as_dict(),
        unit=definition.unit,
        value=single.value_mm,
        calibrated=single.calibrated_mm,
        measured=single.measured_mm,
        limit=found.judged.limit_mm,
        u=u_mm,
        expanded=None if u_mm is None else k * u_mm,
        guard=decided.guard_mm,
        verdict=decided.verdict,
        why=decided.why,
        budget=[
            ContributorTable(name=each.name, u=each.u_mm, formula=each.formula) for each in single.budget.contributors
        ],
        left_out=single.budget.left_out,
        history=None if found.history is None else _history(found.history),
    )


def _history(found: History) -> HistoryTable:
    rests_on = found.basis
    return HistoryTable(
        method=rests_on.method,
        n=rests_on.n,
        fewest=rests_on.fewest,
        span_days=rests_on.span_days,
        said=rests_on.said,
        earlier=found.earlier,
        not_used=found.not_used,
        centre=found.centre,
        lower=found.lower,
        upper=found.upper,
        average=found.average,
        average_lower=found.average_lower,
        average_upper=found.average_upper,
        in_control=found.in_control,
        signals=[SignalTable(rule=each.rule, words=each.words, slow=each.slow) for each in found.signals],
        notes=list(found.notes),
    )


def advice_table(found: Advice) -> AdviceTable:
    """What to try."""
    return AdviceTable(test=found.test, figures=found.figures, why=found.why, steps=found.steps)
