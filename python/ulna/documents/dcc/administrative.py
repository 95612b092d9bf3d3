"""Who calibrated what, for whom, where and when: `dcc:administrativeData`."""

from __future__ import annotations

import re

from ulna.documents.dcc.sheet import Element, Sheet, Texts
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import (
    Address,
    CertificateTable,
    ContactTable,
    ItemTable,
    LaboratoryTable,
    PersonTable,
)
from ulna.ground.version import VERSION

#: where PTB and the DKD explain the refTypes that begin with `basic_`
_BASIC = "https://digilab.ptb.de/dkd/refType/vocab/"


def release(version: str) -> str:
    """A version as PTB's Schematron wants it: `v` and up to four numbers."""
    numbers = re.match(r"\d{1,3}(\.\d{1,3}){0,3}", version)
    return f"v{numbers[0] if numbers else '0'}"


def administrative_data(sheet: Sheet, root: Element, laboratory: Laboratory) -> Element:
    """All of it but the statements, which come last; the element is handed back for them."""
    file = laboratory.file
    data = sheet.dcc(root, "administrativeData")
    software(sheet, sheet.dcc(data, "dccSoftware"), VERSION)
    _ref_types(sheet, data)
    _core_data(sheet, data, file.certificate, file.languages)
    _item(sheet, data, file.item)
    _laboratory(sheet, data, file.laboratory)
    persons = sheet.dcc(data, "respPersons")
    for person in file.person:
        _person(sheet, persons, person)
    _contact(sheet, sheet.dcc(data, "customer"), file.customer)
    return data


def software(sheet: Sheet, parent: Element, version: str) -> None:
    """Ulna, of that version, in a list of software."""
    element = sheet.dcc(parent, "software")
    sheet.text(element, "name", _same(sheet, "Ulna"))
    sheet.dcc(element, "release", release(version))
    sheet.dcc(element, "type", "application")
    sheet.text(element, "description", sheet.own("dcc.software", version=version))


def _same(sheet: Sheet, text: str) -> Texts:
    """A name, the same in all languages."""
    return sheet.theirs(text)


def _ref_types(sheet: Sheet, data: Element) -> None:
    definition = sheet.dcc(sheet.dcc(data, "refTypeDefinitions"), "refTypeDefinition")
    sheet.text(definition, "name", _same(sheet, "basic"))
    sheet.dcc(definition, "namespace", "basic")
    sheet.dcc(definition, "link", _BASIC)


def _core_data(sheet: Sheet, data: Element, certificate: CertificateTable, languages: list[str]) -> None:
    core = sheet.dcc(data, "coreData")
    sheet.dcc(core, "countryCodeISO3166_1", certificate.country)
    for language in languages:
        sheet.dcc(core, "usedLangCodeISO639_1", language)
    sheet.dcc(core, "mandatoryLangCodeISO639_1", languages[0])
    sheet.dcc(core, "uniqueIdentifier", certificate.identifier)
    if certificate.order is not None:
        numbers = sheet.dcc(core, "identifications")
        identification(
            sheet, numbers, "calibrationLaboratory", certificate.order, sheet.own("dcc.order"), "basic_orderNumber"
        )
    if certificate.received is not None:
        sheet.dcc(core, "receiptDate", certificate.received.isoformat())
    sheet.dcc(core, "beginPerformanceDate", certificate.begin.isoformat())
    sheet.dcc(core, "endPerformanceDate", certificate.end.isoformat())
    sheet.dcc(core, "performanceLocation", certificate.location)
    if certificate.issued is not None:
        sheet.dcc(core, "issueDate", certificate.issued.isoformat())
    if certificate.replaces is not None:
        replaced = sheet.dcc(core, "reportAmendedSubstituted")
        sheet.dcc(replaced, "typeOfChange", certificate.replaces.change)
        sheet.dcc(replaced, "replacedUniqueIdentifier", certificate.replaces.identifier)


def identification(
    sheet: Sheet, parent: Element, issuer: str, value: str, name: Texts | None = None, ref: str | None = None
) -> None:
    """A number by which somebody knows a thing."""
    element = sheet.dcc(parent, "identification", ref=ref)
    sheet.dcc(element, "issuer", issuer)
    sheet.dcc(element, "value", value)
    if name is not None:
        sheet.text(element, "name", name)


def _item(sheet: Sheet, data: Element, item: ItemTable) -> None:
    element = sheet.dcc(sheet.dcc(data, "items"), "item")
    sheet.text(element, "name", sheet.theirs(item.name))
    if item.description is not None:
        sheet.text(element, "description", sheet.theirs(item.description))
    sheet.text(sheet.dcc(element, "manufacturer"), "name", _same(sheet, item.manufacturer))
    sheet.dcc(element, "model", item.model)
    numbers = sheet.dcc(element, "identifications")
    identification(sheet, numbers, "manufacturer", item.serial, sheet.own("dcc.serial"), "basic_serialNumber")
    for number in item.identifications:
        name = None if number.name is None else sheet.theirs(number.name)
        identification(sheet, numbers, number.issuer, number.value, name)


def _laboratory(sheet: Sheet, data: Element, laboratory: LaboratoryTable) -> None:
    element = sheet.dcc(data, "calibrationLaboratory")
    if laboratory.code is not None:
        sheet.dcc(element, "calibrationLaboratoryCode", laboratory.code)
    elif laboratory.accreditation is not None:
        sheet.dcc(element, "calibrationLaboratoryCode", laboratory.accreditation.number)
    _contact(sheet, sheet.dcc(element, "contact"), laboratory)


def _contact(sheet: Sheet, element: Element, contact: ContactTable) -> None:
    sheet.text(element, "name", sheet.theirs(contact.name))
    for tag, text in (("eMail", contact.email), ("phone", contact.phone), ("link", contact.web)):
        if text is not None:
            sheet.dcc(element, tag, text)
    _location(sheet, element, contact.address)


def _location(sheet: Sheet, parent: Element, address: Address) -> None:
    element = sheet.dcc(parent, "location")
    parts = (
        ("city", address.city),
        ("countryCode", address.country),
        ("postCode", address.postcode),
        ("state", address.state),
        ("street", address.street),
    )
    for tag, text in parts:
        if text is not None:
            sheet.dcc(element, tag, text)


def _person(sheet: Sheet, parent: Element, person: PersonTable) -> None:
    element = sheet.dcc(parent, "respPerson")
    contact = sheet.dcc(element, "person")
    sheet.text(contact, "name", _same(sheet, person.name))
    for tag, text in (("eMail", person.email), ("phone", person.phone)):
        if text is not None:
            sheet.dcc(contact, tag, text)
    sheet.dcc(element, "role", sheet.theirs(person.role)[0][1])
    sheet.dcc(element, "mainSigner", "true" if person.main_signer else "false")
