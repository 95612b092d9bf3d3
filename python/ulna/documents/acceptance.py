"""The acceptance test of a report: read, and whether it is of this arm."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ulna.calibration.result import Result
from ulna.documents.content import Said, TestedLengths, Verification
from ulna.formats.toml import read_bytes, sha256
from ulna.verification.kinds.registry import LENGTHS
from ulna.verification.result_file import TestedTable, VerificationFile, load_verification

F64 = NDArray[np.float64]


def verification(path: Path, result: Result, result_path: Path, result_sha256: str) -> Verification:
    """What `ulna verify` found, with its length errors as arrays. Raises UlnaInputError.

    A test of encoder readings names the arm files that turned them into points: this result, or the arm.toml beside it;
    as found also the arm that the calibration started from. A test of coordinates only names the arm. Where that is not
    this one, it is said.
    """
    file, digest = load_verification(path)
    remarks = []
    arms = file.provenance.arms
    if arms:
        beside = result_path.parent / "arm.toml"
        ours = {result_sha256} | ({sha256(read_bytes(beside, "an arm file"))} if beside.is_file() else set())
        before = {str(each["sha256"]) for each in result.provenance.get("files", [])}
        known = ours | (before if any(state.state == "as-found" for state in file.states) else set())
        for each in arms:
            if each.sha256 not in known:
                remarks.append(Said("verification.other-arm", {"file": path.name, "arm": each.path}))
    elif file.arm != result.arm.name:
        remarks.append(Said("verification.by-name", {"file": path.name, "arm": file.arm}))
    lengths = [
        _lengths(state.state, test)
        for state in file.states
        for test in state.tests
        if test.kind in LENGTHS and test.figures
    ]
    return Verification(path.name, digest, file, remarks, lengths)


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
