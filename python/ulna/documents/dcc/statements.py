"""What holds for the whole certificate: draft, traceability, uncertainty, rounding, and what was not determined."""

from __future__ import annotations

import math

from ulna.arm.directions import combination
from ulna.arm.unknown import Unknown
from ulna.calibration.result import Result
from ulna.documents.certified.parameters import StatedParameters
from ulna.documents.dcc.sheet import Element, Sheet, Texts
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.issued import Issued
from ulna.ground.digits import degrees_of_freedom


def statement(sheet: Sheet, parent: Element, name: Texts, text: Texts, ref: str | None = None) -> Element:
    """One statement with its declaration."""
    element = sheet.dcc(parent, "statement", ref=ref)
    sheet.text(element, "name", name)
    sheet.text(element, "declaration", text)
    return element


def statements(
    sheet: Sheet,
    parent: Element,
    laboratory: Laboratory,
    result: Result,
    stated: StatedParameters,
    issued: Issued | None = None,
) -> None:
    """All but those on conformity."""
    _standing(sheet, parent, issued)
    _laboratory(sheet, parent, laboratory)
    if stated.fitted:
        statement(sheet, parent, sheet.own("section.uncertainty"), _uncertainty(sheet, result, stated))
    accredited = laboratory.file.laboratory.accreditation is not None
    rounding = "dcc.rounding-accredited" if accredited else "dcc.rounding"
    statement(sheet, parent, sheet.own("dcc.rounding-name"), sheet.own(rounding))
    if accredited and stated.fitted:
        statement(sheet, parent, sheet.own("dcc.cmc-name"), sheet.own("dcc.cmc-parameters"))
    _not_determined(sheet, parent, result, stated)
    for remark in laboratory.file.remarks:
        statement(sheet, parent, sheet.own("laboratory.remark"), sheet.theirs(remark))


def _standing(sheet: Sheet, parent: Element, issued: Issued | None) -> None:
    """A draft, or issued by whom; where it stands in a record."""
    if issued is None:
        statement(sheet, parent, sheet.own("dcc.draft-name"), sheet.own("dcc.draft"))
        return
    by = {"day": issued.day.isoformat(), "by": issued.issued_by, "approved": issued.authorised_by}
    statement(sheet, parent, sheet.own("laboratory.issued"), sheet.own("dcc.issued", **by))
    if issued.audit_head is not None:
        name = sheet.own("provenance.audit-head")
        statement(sheet, parent, name, sheet.theirs(issued.audit_head))


def _laboratory(sheet: Sheet, parent: Element, laboratory: Laboratory) -> None:
    file = laboratory.file
    traceability = file.traceability
    said = sheet.own("dcc.traceability-missing") if traceability is None else sheet.theirs(traceability.statement)
    statement(sheet, parent, sheet.own("section.traceability"), said, "basic_metrologicallyTraceableToSI")
    for key in ("item-alone", "in-full"):
        statement(sheet, parent, sheet.own("section.statements"), sheet.own(f"statement.{key}"))
    condition = file.item.condition
    said = sheet.own("laboratory.not-stated") if condition is None else sheet.theirs(condition)
    statement(sheet, parent, sheet.own("laboratory.condition"), said)
    accredited = file.laboratory.accreditation
    if accredited is not None:
        key = "dcc.accreditation" if accredited.standard is None else "dcc.accreditation-standard"
        text = sheet.own(key, body=accredited.body, number=accredited.number, standard=accredited.standard)
        statement(sheet, parent, sheet.own("laboratory.accreditation"), text)


def _uncertainty(sheet: Sheet, result: Result, stated: StatedParameters) -> Texts:
    known = math.isinf(stated.degrees_of_freedom)
    freedom = degrees_of_freedom(stated.degrees_of_freedom)
    return sheet.own(
        "dcc.uncertainty",
        distribution=sheet.own("dcc.normal") if known else sheet.own("dcc.student", freedom=freedom),
        noise=_noise(sheet, result),
        p=f"{100 * stated.p:g} %",
    )


def _noise(sheet: Sheet, result: Result) -> Texts:
    """Where it is from, and what the residuals made of it."""
    found = result.fit.reading_scatter
    if not result.provenance.get("noise"):
        return sheet.own("dcc.noise-estimated")
    if found is not None and found.factor not in (None, 1.0):
        return sheet.own("dcc.noise-scaled", factor=f"{found.factor:.3g}")
    return sheet.own("dcc.noise-stated")


def _not_determined(sheet: Sheet, parent: Element, result: Result, stated: StatedParameters) -> None:
    for lost in result.identifiability.lost:
        text = sheet.own(
            "dcc.lost",
            combination=combination(lost["combination"]),
            because=lost["because"],
            remedy=lost["remedy"],
        )
        statement(sheet, parent, sheet.own("dcc.lost-name"), text)
    if stated.unsure:
        names = ", ".join(row.name for row in stated.unsure)
        statement(sheet, parent, sheet.own("section.uncertainty"), _unsure(sheet, stated, names))
    if stated.held:
        names = ", ".join(row.name for row in stated.held)
        statement(sheet, parent, sheet.own("dcc.held-name"), sheet.own("dcc.held", names=names))
    if result.identifiability.from_prior:
        names = ", ".join(result.identifiability.from_prior)
        statement(sheet, parent, sheet.own("dcc.prior-name"), sheet.own("dcc.prior", names=names))


def _unsure(sheet: Sheet, stated: StatedParameters, names: str) -> Texts:
    why = stated.unknown or Unknown("freedom")
    return sheet.own(f"dcc.unsure-{why.kind}", names=names, loss=why.loss, each=f"{why.each:.1f}")
