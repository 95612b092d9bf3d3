"""How and under what conditions was measured: methods, standards, environment, input files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath

from ulna.calibration.result import Result
from ulna.documents.dcc.administrative import identification
from ulna.documents.dcc.quantities import quantity, real, standard_real
from ulna.documents.dcc.sheet import Element, Sheet, Texts
from ulna.documents.laboratory.tables import (
    EnvironmentTable,
    EquipmentTable,
    HumidityCondition,
    LaboratoryFile,
    MethodTable,
    TemperatureCondition,
)


def calibration_method(sheet: Sheet, parent: Element, result: Result) -> None:
    """What Ulna did, as one of the used methods."""
    method = sheet.dcc(parent, "usedMethod")
    sheet.text(method, "name", sheet.own("dcc.method"))
    search = {"lm": "Levenberg–Marquardt"}.get(result.fit.method, f"{result.fit.method}, Levenberg–Marquardt")
    if result.fit.loss != "none":
        search += f", {result.fit.loss}"
    extras = ", ".join(result.arm.extras)
    effects = sheet.own("dcc.effects", extras=extras) if extras else ""
    sheet.text(method, "description", sheet.own("dcc.method-text", search=search, effects=effects))


def laboratory_methods(sheet: Sheet, parent: Element, methods: list[MethodTable]) -> None:
    """The procedures that the laboratory names."""
    for each in methods:
        method = sheet.dcc(parent, "usedMethod")
        sheet.text(method, "name", sheet.theirs(each.name))
        if each.description is not None:
            sheet.text(method, "description", sheet.theirs(each.description))
        for norm in each.norms:
            sheet.dcc(method, "norm", norm)
        for reference in each.references:
            sheet.dcc(method, "reference", reference)


def equipment(sheet: Sheet, parent: Element, standards: list[EquipmentTable]) -> None:
    """`dcc:measuringEquipments`, where the laboratory names any."""
    if not standards:
        return
    element = sheet.dcc(parent, "measuringEquipments")
    for standard in standards:
        one = sheet.dcc(element, "measuringEquipment", ref="basic_measurementStandard")
        sheet.text(one, "name", sheet.theirs(standard.name))
        if standard.certificate is not None:
            sheet.text(one, "description", _certified(sheet, standard.certificate, standard.certified_by))
        if standard.manufacturer is not None:
            sheet.text(sheet.dcc(one, "manufacturer"), "name", sheet.theirs(standard.manufacturer))
        if standard.model is not None:
            sheet.dcc(one, "model", standard.model)
        numbers = sheet.dcc(one, "identifications")
        identification(sheet, numbers, "manufacturer", standard.serial, sheet.own("dcc.serial"), "basic_serialNumber")


def _certified(sheet: Sheet, certificate: str, issuer: str | None) -> Texts:
    if issuer is None:
        return sheet.own("dcc.own-certificate", certificate=certificate)
    return sheet.own("dcc.certified-by", certificate=certificate, issuer=issuer)


def influence_conditions(
    sheet: Sheet, parent: Element, environment: EnvironmentTable, status: str | None = None
) -> Element:
    """`dcc:influenceConditions`: how warm and damp it was."""
    element = sheet.dcc(parent, "influenceConditions")
    _condition(sheet, element, environment.temperature, "temperature", environment.temperature.unit, 1.0, status)
    if environment.humidity is not None:
        _condition(sheet, element, environment.humidity, "humidity", "1", 100.0, status)
    for key, text in (
        ("humidity", sheet.own("dcc.humidity-missing") if environment.humidity is None else None),
        ("environment", None if environment.remark is None else sheet.theirs(environment.remark)),
    ):
        if text is not None:
            condition = sheet.dcc(element, "influenceCondition")
            sheet.text(condition, "name", sheet.own(f"dcc.{key}"))
            sheet.text(sheet.dcc(condition, "data"), "text", text)
    return element


def _condition(
    sheet: Sheet,
    parent: Element,
    condition: TemperatureCondition | HumidityCondition,
    key: str,
    unit: str,
    divisor: float,
    status: str | None,
) -> None:
    ref = {"temperature": "basic_temperature", "humidity": "basic_humidityRelative"}[key]
    element = sheet.dcc(parent, "influenceCondition", ref=ref)
    sheet.text(element, "name", sheet.own(f"dcc.{key}"))
    if status is not None:
        sheet.dcc(element, "status", status)
    data = sheet.dcc(element, "data")
    if condition.value is not None and condition.u is not None:
        one = quantity(sheet, data, sheet.own(f"dcc.{key}"), ref)
        standard_real(sheet, one, condition.value / divisor, unit, condition.u / divisor)
        return
    assert condition.low is not None  # the file was checked
    assert condition.high is not None
    for end, value in (("low", condition.low), ("high", condition.high)):
        one = quantity(sheet, data, sheet.own(f"dcc.{key}-{end}"), ref + {"low": "Min", "high": "Max"}[end])
        real(sheet, one, value / divisor, unit)


def input_files(sheet: Sheet, parent: Element, files: Sequence[tuple[str, str]]) -> None:
    """A dcc:metaData: from what files (path, SHA-256) something was made; by their names alone."""
    data = sheet.dcc(parent, "metaData")
    sheet.text(data, "name", sheet.own("dcc.inputs"))
    content = sheet.dcc(data, "data")
    for path, sha256 in files:
        sheet.text(content, "text", sheet.theirs(f"{PurePath(path).name}, SHA-256 {sha256}"))


def laboratory_conditions(sheet: Sheet, parent: Element, file: LaboratoryFile, status: str | None = None) -> Element:
    """Standards and environment, in the order that the schema wants; status: `beforeAdjustment` and the like. The
    element of the conditions is handed back for more."""
    equipment(sheet, parent, file.equipment)
    return influence_conditions(sheet, parent, file.environment, status)
