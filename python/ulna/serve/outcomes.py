"""What checks and acceptance tests found, as it goes over the wire."""

from __future__ import annotations

from pathlib import Path

from ulna.checking.result_file import CheckedTable, load_check
from ulna.serve.contract import outcomes as wire
from ulna.serve.texts import valued
from ulna.verification.result_file import FigureTable, load_verification


def checked(sha256: str, path: Path) -> wire.CheckOutcome:
    """What `ulna check -o` wrote. Raises UlnaInputError for what is none."""
    found, _, _ = load_check(path)
    return wire.CheckOutcome(
        sha256=sha256,
        protocol=found.protocol.name,
        arm=found.arm,
        at=found.time,
        operator=found.operator,
        verdict=found.verdict,
        in_control=found.in_control,
        figures=[_checked(each) for each in found.figures],
        departures=found.departures,
        advice=[
            wire.Advised(test=each.test, figures=each.figures, why=each.why, steps=each.steps) for each in found.advice
        ],
        remarks=found.provenance.warnings,
    )


def _checked(found: CheckedTable) -> wire.CheckedFigure:
    past = found.history
    return wire.CheckedFigure(
        test=found.test,
        key=found.key,
        name=found.name,
        of=list(found.of.items()),
        value=valued(found.value, found.unit, found.u, found.expanded),
        limit=None if found.limit is None else valued(found.limit, found.unit),
        verdict=found.verdict,
        why=found.why,
        centre_mm=None if past is None else past.centre,
        lower_mm=None if past is None else past.lower,
        upper_mm=None if past is None else past.upper,
        average_mm=None if past is None else past.average,
        in_control=None if past is None else past.in_control,
        signals=[] if past is None else [each.words for each in past.signals],
        history=None if past is None else past.said,
    )


def verified(sha256: str, path: Path) -> wire.VerificationOutcome:
    """What `ulna verify -o` wrote. Raises UlnaInputError for what is none."""
    found, _ = load_verification(path)
    return wire.VerificationOutcome(
        sha256=sha256,
        arm=found.arm,
        profile=found.profile.name,
        standard=found.profile.standard,
        statement=found.profile.statement,
        decision=found.decision.text,
        verdict=found.verdict,
        states=[
            wire.StateInfo(
                state=state.state,
                verdict=state.verdict,
                departures=state.departures,
                tests=[
                    wire.TestedInfo(
                        test=each.name,
                        kind=each.kind,
                        readings=each.readings,
                        verdict=each.verdict,
                        departures=each.departures,
                        figures=[_figure(figure) for figure in each.figures],
                    )
                    for each in state.tests
                ],
            )
            for state in found.states
        ],
        remarks=found.provenance.warnings,
    )


def _figure(found: FigureTable) -> wire.TestFigure:
    return wire.TestFigure(
        key=found.key,
        name=found.name,
        formula=found.formula,
        value=valued(found.value, found.unit, found.u, found.expanded),
        limit=None if found.limit is None else valued(found.limit, found.unit),
        verdict=found.verdict,
        why=found.why,
        values=len(found.individual),
    )
