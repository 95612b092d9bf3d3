"""Tests of the arm: test values with their uncertainties, and what they say of conformity."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.documents.certified.test_values import StatedTest, StatedTests, Temperature
from ulna.documents.dcc.administrative import software
from ulna.documents.dcc.conditions import input_files, laboratory_conditions
from ulna.documents.dcc.quantities import Expanded, quantity, real, real_list, standard_real, two_digits
from ulna.documents.dcc.results import result_of
from ulna.documents.dcc.risks import risks
from ulna.documents.dcc.sheet import Element, Sheet, Texts
from ulna.documents.dcc.statements import statement
from ulna.documents.laboratory.tables import LaboratoryFile
from ulna.documents.sections.decision import rule
from ulna.documents.sections.verification import lifted, not_covered

#: of the conditions, as DCC calls the state of the arm
_STATUS: dict[str, str] = {"as-found": "beforeAdjustment", "as-left": "afterAdjustment"}


def tests_result(
    sheet: Sheet, of_laboratory: Sheet, measured: Element, tests: StatedTests, file: LaboratoryFile
) -> None:
    """A dcc:measurementResult of the arm in one state, with a dcc:result for each test."""
    element = sheet.dcc(measured, "measurementResult")
    sheet.text(element, "name", _title(sheet, tests))
    method = sheet.dcc(sheet.dcc(element, "usedMethods"), "usedMethod")
    sheet.text(method, "name", sheet.own("dcc.test-method", manner=tests.manner))
    sheet.text(method, "description", sheet.own("dcc.test-method-text"))
    sheet.dcc(method, "reference", f"evaluated in the manner of {tests.manner.strip()}".strip())
    software(sheet, sheet.dcc(element, "usedSoftware"), tests.version)
    status = _STATUS[tests.state]
    conditions = laboratory_conditions(of_laboratory, element, file, status)
    if tests.temperature is not None:
        _temperature(sheet, conditions, tests.temperature, status)
    results = sheet.dcc(element, "results")
    for name in dict.fromkeys(value.test for value in tests.values):
        data = result_of(sheet, results, sheet.theirs(name))
        for value in tests.values:
            if value.test == name:
                _value(sheet, data, value, tests)
                _singles(sheet, data, value, tests.accredited)
    metas = sheet.dcc(element, "measurementMetaData")
    if tests.departures:
        meta = sheet.dcc(metas, "metaData")
        sheet.text(meta, "name", sheet.own("dcc.departures"))
        data = sheet.dcc(meta, "data")
        for departure in tests.departures:
            sheet.text(data, "text", sheet.theirs(departure))
    input_files(sheet, metas, tests.files)


def _title(sheet: Sheet, tests: StatedTests) -> Texts:
    return sheet.own(f"dcc.title-{tests.state}", profile=tests.profile)


def _rule(sheet: Sheet, tests: StatedTests) -> Texts:
    return sheet.spoken(lambda words, _: rule(tests.rule, words))


def _temperature(sheet: Sheet, conditions: Element, temperature: Temperature, status: str) -> None:
    condition = sheet.dcc(conditions, "influenceCondition")
    sheet.text(condition, "name", sheet.own("dcc.artefact-temperature"))
    sheet.dcc(condition, "status", status)
    one = quantity(sheet, sheet.dcc(condition, "data"), sheet.own("dcc.artefact-temperature"))
    standard_real(sheet, one, temperature.value_c, "°C", temperature.u_k)


def _value(sheet: Sheet, data: Element, value: StatedTest, tests: StatedTests) -> None:
    one = quantity(sheet, data, sheet.theirs(value.name), "basic_measuredValue", sheet.theirs(value.formula))
    expanded = None if value.expanded is None else (value.expanded, value.k, value.p)
    real(sheet, one, value.value, value.unit, expanded, tests.accredited)
    metas = sheet.dcc(one, "measurementMetaData")
    meta = sheet.dcc(metas, "metaData", ref="basic_conformity")
    sheet.text(meta, "name", sheet.own("dcc.conformity"))
    sheet.text(meta, "declaration", _declared(sheet, value, _rule(sheet, tests)))
    if value.limit is not None:
        if value.conformity is not None:
            sheet.dcc(meta, "conformity", value.conformity)
        limits = sheet.dcc(meta, "data")
        real(sheet, quantity(sheet, limits, sheet.own("dcc.limit")), value.limit, value.unit)
        if value.guard is not None:
            guard = two_digits(value.guard, tests.accredited)
            real(sheet, quantity(sheet, limits, sheet.own("dcc.guard")), guard, value.unit)
        if value.risk is not None:
            risks(sheet, limits, value.risk)
    _budget(sheet, metas, value, tests.accredited)


def _declared(sheet: Sheet, value: StatedTest, decided: Texts) -> Texts:
    if value.limit is None:
        return sheet.own("dcc.no-limit")
    word = value.conformity
    return sheet.own("dcc.undecidable" if word is None else f"dcc.says-{word}", rule=decided)


def _budget(sheet: Sheet, metas: Element, value: StatedTest, accredited: bool) -> None:
    """What the uncertainty is made of, and what is not in it."""
    if not value.budget and not value.left_out:
        return
    meta = sheet.dcc(metas, "metaData")
    sheet.text(meta, "name", sheet.own("dcc.budget"))
    data = sheet.dcc(meta, "data")
    if value.budget:
        names = [name for name, _ in value.budget]
        contributions = [two_digits(u, accredited) for _, u in value.budget]
        one = quantity(sheet, data, sheet.own("dcc.contributors"))
        real_list(sheet, one, names, contributions, [value.unit] * len(names))
    for text in value.left_out:
        sheet.text(data, "text", sheet.own("dcc.left-out", what=text))


def _singles(sheet: Sheet, data: Element, value: StatedTest, accredited: bool) -> None:
    """All values of a figure that has more than one."""
    if len(value.singles) < 2:
        return
    one = quantity(sheet, data, sheet.own("dcc.singles", name=value.name))
    expanded = [single.expanded for single in value.singles if single.expanded is not None]
    labels = [single.label or str(number) for number, single in enumerate(value.singles, start=1)]
    real_list(
        sheet,
        one,
        labels,
        [single.value for single in value.singles],
        [value.unit] * len(labels),
        Expanded(expanded, value.k, value.p, rounded=accredited) if len(expanded) == len(labels) else None,
    )
    known = [single.probability for single in value.singles if single.probability is not None]
    words = [single.conformity for single in value.singles if single.conformity is not None]
    if len(words) == len(labels):
        metas = sheet.dcc(one, "measurementMetaData")
        meta = sheet.dcc(metas, "metaData", ref="basic_conformity")
        sheet.text(meta, "name", sheet.own("dcc.conformity"))
        sheet.dcc(meta, "conformityXMLList", " ".join(words))
        if len(known) == len(labels):
            probabilities = quantity(sheet, sheet.dcc(meta, "data"), sheet.own("dcc.conformity-probability"))
            real_list(sheet, probabilities, labels, known, ["1"] * len(labels))


def _capability(sheet: Sheet, tests: StatedTests) -> Iterator[Texts]:
    """Which U was lifted to the laboratory's CMC, and of which figures it states none."""
    for each in tests.lifted:
        yield sheet.spoken(lambda words, _, each=each: lifted(each, words))  # type: ignore[misc]
    if tests.without:
        yield sheet.own("verification.no-cmc", figures=", ".join(tests.without))


def conformity_statements(sheet: Sheet, statements: Element, tests: StatedTests) -> None:
    """What the profile says of itself, and a statement on the whole, with its rule."""
    statement(sheet, statements, _title(sheet, tests), sheet.theirs(tests.statement))
    for text in _capability(sheet, tests):
        statement(sheet, statements, sheet.own("dcc.cmc-name"), text)
    covered = sheet.spoken(lambda words, _: not_covered(tests.scanner, words))
    statement(sheet, statements, sheet.own("dcc.not-covered-name"), covered)
    word = tests.conformity
    if word is None:
        return
    said = sheet.own(f"dcc.whole-{word}", title=_title(sheet, tests), rule=_rule(sheet, tests))
    element = statement(sheet, statements, sheet.own("dcc.conformity"), said, "basic_conformity")
    sheet.dcc(element, "conformity", word)
