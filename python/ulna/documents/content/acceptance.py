"""The acceptance test of a report: its length errors with limits, and what is said on the whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ulna.documents.laboratory.capability import stated_by
from ulna.documents.laboratory.tables import LaboratoryFile
from ulna.documents.languages.said import Said
from ulna.documents.sources.source import Taken
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.verification.kinds.registry import LENGTHS
from ulna.verification.lifted import Lifted
from ulna.verification.result_file import TestedTable, VerificationFile


@dataclass(frozen=True)
class TestedLengths:
    """Length errors of an acceptance test over their lengths."""

    state: str
    """"as-found" or "as-left"."""
    test: str
    figure: str
    length_mm: F64
    """(N,) calibrated."""
    error_mm: F64
    limit_mm: F64
    """(N,) MPE; NaN where none is stated."""
    guard_mm: F64
    """(N,) NaN where it is not known."""
    verdict: list[str | None]
    """"pass", "fail", "undecided" or None."""
    a_mm: float | None
    """MPE = a + L / b; None where none is stated."""
    b: float | None


@dataclass(frozen=True)
class Verification:
    """What `ulna verify` found."""

    file: VerificationFile
    """Of several files one, with the states of all."""
    remarks: list[Said]
    """Where it is not of this result's arm."""
    lengths: list[TestedLengths]
    lifted: list[Lifted] = field(default_factory=list)
    """Where U was below the laboratory's CMC."""
    without: list[str] = field(default_factory=list)
    """Short names of figures of which an accredited laboratory states no CMC."""
    scanner: str | None = None
    """What the arm carries beside its probe."""


def verification(
    taken: Sequence[Taken[VerificationFile]], laboratory: LaboratoryFile | None = None
) -> Verification | None:
    """What `ulna verify` found, as the laboratory may state it, with its length errors as arrays; None of no file.
    Raises UlnaInputError for files that are no one test, as found and as left."""
    if not taken:
        return None
    stated = stated_by(one_test(taken), laboratory)
    lengths = [
        _lengths(state.state, test)
        for state in stated.file.states
        for test in state.tests
        if test.kind in LENGTHS and test.figures
    ]
    return Verification(
        stated.file,
        [said for each in taken for said in each.remarks],
        lengths,
        stated.lifted,
        stated.without,
        scanner_of(stated.file, laboratory),
    )


def one_test(taken: Sequence[Taken[VerificationFile]]) -> VerificationFile:
    """As found and as left in one. Raises UlnaInputError where a state stands twice, or one was decided otherwise."""
    first, *others = taken
    for each in others:
        same = {
            "profile.name": each.value.profile.name == first.value.profile.name,
            "decision": each.value.decision == first.value.decision,
        }
        for key in (key for key, is_same in same.items() if not is_same):
            raise UlnaInputError(
                f"{each.file.path}: key '{key}': differs from that of {first.file.path}; expected one profile and one "
                "decision rule as found and as left. Verify one of them again, or give one alone."
            )
    states = [state for each in taken for state in each.value.states]
    names = [state.state for state in states]
    if len(set(names)) != len(names):
        raise UlnaInputError(
            f"{taken[-1].file.path}: key 'states': {', '.join(names)} of all files given; expected each state once. "
            "Give one file for each."
        )
    states.sort(key=lambda state: state.state != "as-found")
    every = [each for file in taken for each in file.value.artefacts]
    artefacts = [each for k, each in enumerate(every) if each not in every[:k]]
    return first.value.model_copy(update={"states": states, "artefacts": artefacts})


def scanner_of(file: VerificationFile, laboratory: LaboratoryFile | None) -> str | None:
    """What the arm carries beside its probe, as the laboratory or the verify file says."""
    named = None if laboratory is None else laboratory.item.scanner
    return named or file.scanner


def _lengths(state: str, test: TestedTable) -> TestedLengths:
    """Of a test's first figure, whose single values are length errors."""
    figure = test.figures[0]
    values = [value for value in figure.individual if value.calibrated is not None]
    terms = figure.limit_terms

    def of(name: str) -> list[float]:
        return [np.nan if getattr(value, name) is None else getattr(value, name) for value in values]

    return TestedLengths(
        state=state,
        test=test.name,
        figure=figure.name,
        length_mm=np.array(of("calibrated")),
        error_mm=np.array([value.value for value in values]),
        limit_mm=np.array(of("limit")),
        guard_mm=np.array(of("guard")),
        verdict=[value.verdict for value in values],
        a_mm=None if terms is None else terms.a,
        b=None if terms is None else terms.b,
    )


def limit_lines(found: TestedLengths) -> tuple[F64, F64, F64] | None:
    """Lengths, the MPE there and the half width g of the guard band about it, each (M,) mm: what limits look like over
    the length, going on a little beyond the shortest and the longest. None where no MPE is stated."""
    if found.a_mm is None or not len(found.length_mm):
        return None
    low, high = float(found.length_mm.min()), float(found.length_mm.max())
    margin = 0.04 * (high - low) or 0.05 * high
    at, first = np.unique(found.length_mm.round(6), return_index=True)
    x = np.concatenate([[max(low - margin, 0.0)], at, [high + margin]])
    guard = np.nan_to_num(found.guard_mm[first])
    guard = np.concatenate([guard[:1], guard, guard[-1:]])
    limit = np.full(len(x), found.a_mm) if found.b is None else found.a_mm + x / found.b
    return x, limit, guard


@dataclass(frozen=True)
class Whole:
    """What is said of one state of the arm on the whole, and of what nothing is said."""

    state: str
    verdict: str | None
    unmeasured: int
    """Tests of the profile."""
    silent: int
    """Figures without a verdict."""


def wholes(found: VerificationFile) -> list[Whole]:
    """Of each state: as found and as left are judged by themselves."""
    return [
        Whole(
            state.state,
            state.verdict,
            len(state.departures),
            sum(figure.verdict is None for test in state.tests for figure in test.figures),
        )
        for state in found.states
    ]
