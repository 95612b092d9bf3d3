"""Tests of the arm: test values with their uncertainties, and what they say of conformity."""

from __future__ import annotations

from collections.abc import Sequence

from ulna.certificate.dcc.administrative import software
from ulna.certificate.dcc.conditions import laboratory_conditions
from ulna.certificate.dcc.quantities import quantity, real
from ulna.certificate.dcc.results import result_of
from ulna.certificate.dcc.sheet import Element, Said, Sheet
from ulna.certificate.dcc.statements import statement
from ulna.certificate.tested import StatedTest, StatedTests
from ulna.files.laboratory_tables import LaboratoryFile


def tests_result(
    sheet: Sheet, of_laboratory: Sheet, measured: Element, tests: StatedTests, file: LaboratoryFile
) -> None:
    """A dcc:measurementResult of one test in one state of the arm."""
    element = sheet.dcc(measured, "measurementResult")
    sheet.text(element, "name", sheet.theirs(tests.title))
    method = sheet.dcc(sheet.dcc(element, "usedMethods"), "usedMethod")
    sheet.text(method, "name", sheet.own("test-method", manner=tests.manner))
    sheet.text(method, "description", sheet.own("test-method-text"))
    sheet.dcc(method, "reference", f"evaluated in the manner of {tests.manner}")
    software(sheet, sheet.dcc(element, "usedSoftware"), tests.version)
    laboratory_conditions(of_laboratory, element, file)
    data = result_of(sheet, sheet.dcc(element, "results"), sheet.own("test-values"))
    for value in tests.values:
        _value(sheet, data, value, tests.rule)


def _value(sheet: Sheet, data: Element, value: StatedTest, rule: str) -> None:
    one = quantity(sheet, data, sheet.theirs(value.name), "basic_measuredValue", sheet.theirs(value.formula))
    expanded = None
    if value.expanded is not None and value.k is not None and value.p is not None:
        expanded = (value.expanded, value.k, value.p)
    real(sheet, one, value.value, value.unit, expanded)
    meta = sheet.dcc(sheet.dcc(one, "measurementMetaData"), "metaData", ref="basic_conformity")
    sheet.text(meta, "name", sheet.own("conformity"))
    sheet.text(meta, "declaration", _declared(sheet, value, rule))
    if value.limit is None:
        return
    if value.conformity is not None:
        sheet.dcc(meta, "conformity", value.conformity)
    limits = sheet.dcc(meta, "data")
    real(sheet, quantity(sheet, limits, sheet.own("limit")), value.limit, value.unit)
    if value.guard is not None:
        real(sheet, quantity(sheet, limits, sheet.own("guard")), value.guard, value.unit)


def _declared(sheet: Sheet, value: StatedTest, rule: str) -> Said:
    if value.limit is None:
        return sheet.own("no-limit")
    word = value.conformity
    return sheet.own("undecidable" if word is None else f"says-{word}", rule=rule)


def conformity_statements(sheet: Sheet, statements: Element, tested: Sequence[StatedTests]) -> None:
    """For each test one on the whole, with its rule."""
    for tests in tested:
        word = tests.conformity
        if word is None:
            continue
        whole = sheet.own(f"whole-{word}", title=tests.title)
        said = [(language, f"{text} {tests.rule}") for language, text in whole]
        element = statement(sheet, statements, sheet.own("conformity"), said, "basic_conformity")
        sheet.dcc(element, "conformity", word)
