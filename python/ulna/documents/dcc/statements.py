"""What holds for the whole certificate: draft, traceability, uncertainty, rounding, and what was not determined."""

from __future__ import annotations

import math

from ulna.arm.directions import combination
from ulna.calibration.result import Result
from ulna.documents.certified.parameters import StatedParameters
from ulna.documents.dcc.sheet import Element, Said, Sheet
from ulna.documents.laboratory.file import Laboratory


def statement(sheet: Sheet, parent: Element, name: Said, text: Said, ref: str | None = None) -> Element:
    """One statement with its declaration."""
    element = sheet.dcc(parent, "statement", ref=ref)
    sheet.text(element, "name", name)
    sheet.text(element, "declaration", text)
    return element


def statements(sheet: Sheet, parent: Element, laboratory: Laboratory, result: Result, stated: StatedParameters) -> None:
    """All but those on conformity."""
    statement(sheet, parent, sheet.own("draft-name"), sheet.own("draft"))
    _laboratory(sheet, parent, laboratory)
    if stated.fitted:
        statement(sheet, parent, sheet.own("uncertainty-name"), _uncertainty(sheet, stated))
    statement(sheet, parent, sheet.own("rounding-name"), sheet.own("rounding"))
    _not_determined(sheet, parent, result, stated)
    for remark in laboratory.file.remarks:
        statement(sheet, parent, sheet.own("remark"), sheet.theirs(remark))


def _laboratory(sheet: Sheet, parent: Element, laboratory: Laboratory) -> None:
    file = laboratory.file
    traceability = file.traceability
    said = sheet.own("traceability-missing") if traceability is None else sheet.theirs(traceability.statement)
    statement(sheet, parent, sheet.own("traceability-name"), said, "basic_metrologicallyTraceableToSI")
    accredited = file.laboratory.accreditation
    if accredited is not None:
        key = "accreditation" if accredited.standard is None else "accreditation-standard"
        text = sheet.own(key, body=accredited.body, number=accredited.number, standard=accredited.standard)
        statement(sheet, parent, sheet.own("accreditation-name"), text)


def _uncertainty(sheet: Sheet, stated: StatedParameters) -> Said:
    known = math.isinf(stated.degrees_of_freedom)
    freedom = f"{stated.degrees_of_freedom:g}"
    return sheet.own(
        "uncertainty",
        distribution=sheet.own("normal") if known else sheet.own("student", freedom=freedom),
        noise=sheet.own("noise-stated" if known else "noise-estimated"),
        p=f"{100 * stated.p:g} %",
    )


def _not_determined(sheet: Sheet, parent: Element, result: Result, stated: StatedParameters) -> None:
    for lost in result.identifiability.lost:
        text = sheet.own(
            "lost",
            combination=combination(lost["combination"]),
            because=lost["because"],
            remedy=lost["remedy"],
        )
        statement(sheet, parent, sheet.own("lost-name"), text)
    if stated.unsure:
        names = ", ".join(row.name for row in stated.unsure)
        statement(sheet, parent, sheet.own("uncertainty-name"), sheet.own("unsure", names=names))
    if stated.held:
        names = ", ".join(row.name for row in stated.held)
        statement(sheet, parent, sheet.own("held-name"), sheet.own("held", names=names))
    if result.identifiability.from_prior:
        names = ", ".join(result.identifiability.from_prior)
        statement(sheet, parent, sheet.own("prior-name"), sheet.own("prior", names=names))
