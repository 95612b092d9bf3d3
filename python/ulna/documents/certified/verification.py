"""The tests of a verification.json as a certificate states them, and whether they are of the arm it is about."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import NoReturn

from ulna.calibration.result import Result
from ulna.documents.certified.source import MOST
from ulna.documents.certified.test_values import SingleValue, StatedTest, StatedTests, Temperature
from ulna.documents.content.acceptance import scanner_of
from ulna.documents.laboratory.capability import Stated, stated_by
from ulna.documents.laboratory.tables import ItemTable, LaboratoryFile
from ulna.documents.sources.source import Calibration
from ulna.documents.sources.verification import calibrated_arms, strange_arms
from ulna.ground.errors import UlnaInputError
from ulna.verification.lifted import rule_of
from ulna.verification.result_file import FigureTable, StateTable, ValueTable, VerificationFile, load_verification

#: rounding that is forgiven
_SLACK = 1e-9


def stated_tests(path: Path, calibration: Calibration, laboratory: LaboratoryFile) -> list[StatedTests]:
    """The tests of one file, as found before as left, with no U below the laboratory's CMC. Raises UlnaInputError, also
    where they are of another arm."""
    file, digest = load_verification(path)
    _check_arm(file, path, calibration, laboratory.item)
    for state in file.states:
        for test in state.tests:
            for figure in test.figures:
                _check(path, figure)
    stated = stated_by(file, laboratory)
    scanner = scanner_of(file, laboratory)
    return [_state(stated, state, path, digest, scanner) for state in stated.file.states]


def _state(stated: Stated, state: StateTable, path: Path, digest: str, scanner: str | None) -> StatedTests:
    file = stated.file
    if not any(test.figures for test in state.tests):
        raise UlnaInputError(f"{path}: state '{state.state}' has no figure; expected one at the least. Verify again.")
    made, warm = file.provenance, file.environment.temperature
    own = [each for each in made.files if each.state == state.state]
    used = [(each.path, each.sha256) for each in (made.plan, *made.arms)]
    files = [(path.name, digest), *used, *((each.path, each.sha256) for each in own)]
    return StatedTests(
        profile=file.profile.name,
        state=state.state,
        manner=file.profile.standard,
        statement=file.profile.statement,
        rule=rule_of(file.decision),
        version=made.version,
        values=[_figure(test.name, figure) for test in state.tests for figure in test.figures],
        departures=[*state.departures, *(f"{test.name}: {each}" for test in state.tests for each in test.departures)],
        temperature=None if warm is None else Temperature(warm.value, warm.u),
        files=files,
        lifted=[each for each in stated.lifted if each.state == state.state],
        without=stated.without,
        accredited=stated.accredited,
        scanner=scanner,
    )


def _check(path: Path, figure: FigureTable) -> None:
    """Its numbers bear each other out. Raises UlnaInputError."""
    verdicts: list[FigureTable | ValueTable] = [figure, *figure.individual]
    for each in verdicts:
        _check_verdict(path, figure.name, each)
        if each.u is not None and not 0.0 <= figure.k * each.u <= MOST:
            _damaged(path, figure.name, f"the uncertainty is {each.u:g} mm with k = {figure.k:g}")
    if not (1.0 <= figure.k <= MOST and 0.0 < figure.p < 1.0):
        _damaged(path, figure.name, f"k = {figure.k:g} and p = {figure.p:g} are no coverage factor and probability")
    if (figure.u is None) != (figure.expanded is None) or (
        figure.u is not None
        and figure.expanded is not None
        and not math.isclose(figure.expanded, figure.k * figure.u, rel_tol=_SLACK)
    ):
        _damaged(path, figure.name, "expanded is not k times u")


def _figure(test: str, figure: FigureTable) -> StatedTest:
    return StatedTest(
        name=figure.name,
        test=test,
        formula=figure.formula,
        value=figure.value,
        unit=figure.unit,
        expanded=figure.expanded,
        k=figure.k,
        p=figure.p,
        limit=figure.limit,
        guard=figure.guard,
        decision=figure.verdict,
        budget=[(part.name, part.u) for part in figure.budget],
        left_out=figure.left_out,
        singles=[_single(value, figure.k) for value in figure.individual],
        risk=figure.risk,
    )


def _single(value: ValueTable, k: float) -> SingleValue:
    labels = (value.artefact, value.position, value.orientation, value.repeat)
    label = "/".join(each for each in labels if each)
    expanded = None if value.u is None else k * value.u
    return SingleValue(label, value.value, expanded, value.limit, value.verdict, value.conformity)


def _check_verdict(path: Path, name: str, each: FigureTable | ValueTable) -> None:
    """A certificate states no verdict that its numbers do not bear out. Raises UlnaInputError."""
    if each.verdict is None:
        return
    if each.limit is None or each.guard is None:
        _damaged(path, name, f"it has the verdict {each.verdict}, but no limit or no guard band")
    size, slack = abs(each.value), _SLACK * each.limit
    good = {
        "pass": size <= each.limit - each.guard + slack,
        "fail": size > each.limit + each.guard - slack,
        "undecided": each.limit - each.guard - slack < size <= each.limit + each.guard + slack,
    }
    if not good[each.verdict]:
        _damaged(
            path,
            name,
            f"the verdict is {each.verdict}, but {each.value:g} mm with the limit {each.limit:g} mm and the guard band "
            f"{each.guard:g} mm is not",
        )


def _damaged(path: Path, name: str, what: str) -> NoReturn:
    raise UlnaInputError(f"{path}: figure {name}: {what}. The file was changed or damaged: verify again.")


def _check_arm(file: VerificationFile, path: Path, calibration: Calibration, item: ItemTable) -> None:
    """What a report remarks, a certificate refuses; and of tests as left one arm at least must be this calibration's.
    Tests by coordinates name the arm: its serial number must be in it. Raises UlnaInputError."""
    made = file.provenance
    if not made.arms or any(each.points == "xyz" for each in made.files):
        _check_name(file, path, calibration.result, item)
    if not made.arms:
        return
    states = {state.state for state in file.states}
    strange = strange_arms(made.arms, calibration, as_found="as-found" in states)
    calibrated = calibrated_arms(calibration)
    if strange or ("as-left" in states and not any(each.sha256 in calibrated for each in made.arms)):
        raise UlnaInputError(
            f"{path}: key 'provenance.arms': values were computed with {(strange or made.arms)[0].path}, another arm "
            f"than that of {calibration.file.path}; expected tests of this calibration, as found also of the arm that "
            f"it started from. Verify again with: ulna verify {calibration.file.path} PLAN"
        )


def _check_name(file: VerificationFile, path: Path, result: Result, item: ItemTable) -> None:
    if re.search(rf"(?<!\w){re.escape(item.serial)}(?!\w)", file.arm) or file.arm == result.arm.name:
        return
    raise UlnaInputError(
        f"{path}: key 'arm': these tests are of '{file.arm}', the certificate is about serial number '{item.serial}'; "
        "expected that number in the name of the arm. Name the right file, or write the serial number into the key arm "
        "of the verify file and verify again."
    )
