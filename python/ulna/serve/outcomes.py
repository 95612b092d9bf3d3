"""What checks and acceptance tests found, as it goes over the wire."""

from __future__ import annotations

from pathlib import Path

from ulna.checking.advice import steps
from ulna.checking.history import REMARKS
from ulna.checking.outcome import BROKEN
from ulna.checking.result_file import CheckedTable, load_check
from ulna.checking.series import SIGNALS
from ulna.control.basis import SAID
from ulna.ground.worded import recalled
from ulna.serve.contract import outcomes as wire
from ulna.serve.texts import valued
from ulna.verification.departures import FIGURES, FORMULAS, SENTENCES, said_of, said_of_check
from ulna.verification.result_file import FigureTable, load_verification

WHYS = (*SIGNALS, BROKEN)


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
        departures=[said_of_check(each) for each in found.departures],
        advice=[
            wire.Advised(
                test=each.test,
                figures=each.figures,
                why=[recalled(why, WHYS) for why in each.why],
                steps=[recalled(step, steps()) for step in each.steps],
            )
            for each in found.advice
        ],
        remarks=[recalled(each, (*REMARKS, *SENTENCES)) for each in found.provenance.warnings],
    )


def _checked(found: CheckedTable) -> wire.CheckedFigure:
    past = found.history
    return wire.CheckedFigure(
        test=found.test,
        key=found.key,
        name=recalled(found.name, FIGURES),
        of=list(found.of.items()),
        value=valued(found.value, found.unit, found.u, found.expanded),
        limit=None if found.limit is None else valued(found.limit, found.unit),
        verdict=found.verdict,
        why=None if found.why is None else said_of(found.why),
        centre_mm=None if past is None else past.centre,
        lower_mm=None if past is None else past.lower,
        upper_mm=None if past is None else past.upper,
        average_mm=None if past is None else past.average,
        in_control=None if past is None else past.in_control,
        signals=[] if past is None else [recalled(each.words, SIGNALS) for each in past.signals],
        history=None if past is None else recalled(past.said, SAID),
    )


def verified(sha256: str, path: Path) -> wire.VerificationOutcome:
    """What `ulna verify -o` wrote. Raises UlnaInputError for what is none."""
    found, _ = load_verification(path)
    return wire.VerificationOutcome(
        sha256=sha256,
        arm=found.arm,
        profile=found.profile.name,
        standard=found.profile.standard,
        statement=said_of(found.profile.statement),
        decision=said_of(found.decision.text),
        verdict=found.verdict,
        states=[
            wire.StateInfo(
                state=state.state,
                verdict=state.verdict,
                departures=[said_of(each) for each in state.departures],
                tests=[
                    wire.TestedInfo(
                        test=each.name,
                        kind=each.kind,
                        readings=each.readings,
                        verdict=each.verdict,
                        departures=[said_of(text) for text in each.departures],
                        figures=[_figure(figure) for figure in each.figures],
                    )
                    for each in state.tests
                ],
            )
            for state in found.states
        ],
        remarks=[recalled(each, (*REMARKS, *SENTENCES)) for each in found.provenance.warnings],
    )


def _figure(found: FigureTable) -> wire.TestFigure:
    return wire.TestFigure(
        key=found.key,
        name=recalled(found.name, FIGURES),
        formula=recalled(found.formula, FORMULAS),
        value=valued(found.value, found.unit, found.u, found.expanded),
        limit=None if found.limit is None else valued(found.limit, found.unit),
        verdict=found.verdict,
        why=None if found.why is None else said_of(found.why),
        values=len(found.individual),
    )
