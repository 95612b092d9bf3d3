"""What the laboratory says, from its file: who, for whom, which item, with what, traceable how."""

from __future__ import annotations

from ulna.documents.content import Content
from ulna.documents.html.markup import name, paragraph, table
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import Address, ContactTable, HumidityCondition, TemperatureCondition
from ulna.documents.languages.words import Words


def laboratory(content: Content, words: Words) -> str:
    """Certificate, laboratory, customer, item and persons; nothing where there is no laboratory file."""
    found = content.laboratory
    if found is None:
        return ""
    file, language = found.file, words.language
    made = file.certificate
    days = [("received", made.received), ("begin", made.begin), ("end", made.end), ("issued", made.issued)]
    item = file.item
    rows: list[tuple[str, str]] = [
        (words("laboratory.identifier"), name(made.identifier)),
        (words("laboratory.laboratory"), _contact(found, file.laboratory, language)),
        (words("laboratory.customer"), _contact(found, file.customer, language)),
        (
            words("laboratory.item"),
            f"{name(found.spoken(item.name, language))}, {name(item.manufacturer)} {name(item.model)}, "
            f"{words('laboratory.serial')} {name(item.serial)}",
        ),
    ]
    if made.order is not None:
        rows.append((words("laboratory.order"), name(made.order)))
    if file.laboratory.accreditation is not None:
        given = file.laboratory.accreditation
        parts = [given.body, given.number, *([given.standard] if given.standard else [])]
        rows.append((words("laboratory.accreditation"), ", ".join(name(part) for part in parts)))
    rows += [(words(f"laboratory.{key}"), name(day.isoformat())) for key, day in days if day is not None]
    for person in file.person:
        rows.append((name(person.role), name(person.name)))
    for method in file.method:
        more = "".join(f", {name(each)}" for each in (*method.norms, *method.references))
        rows.append((words("laboratory.method"), name(found.spoken(method.name, language)) + more))
    for remark in file.remarks:
        rows.append((words("laboratory.remark"), name(found.spoken(remark, language))))
    return "<dl>" + "".join(f"<dt>{what}</dt><dd>{value}</dd>\n" for what, value in rows) + "</dl>\n"


def _contact(found: Laboratory, contact: ContactTable, language: str) -> str:
    parts = [name(found.spoken(contact.name, language)), *_address(contact.address)]
    parts += [name(each) for each in (contact.email, contact.phone, contact.web) if each is not None]
    return "<br>".join(parts)


def _address(address: Address) -> list[str]:
    place = " ".join(name(each) for each in (address.postcode, address.city) if each is not None)
    country = ", ".join(name(each) for each in (address.state, address.country) if each is not None)
    return [*([name(address.street)] if address.street else []), place, country]


def conditions(content: Content, words: Words) -> str:
    """The room, as the laboratory says it."""
    if content.laboratory is None:
        return ""
    given = content.laboratory.file.environment
    page = paragraph(words("environment.room-temperature", shown=_condition(given.temperature)))
    if given.humidity is not None:
        page += paragraph(words("environment.room-humidity", shown=_condition(given.humidity)))
    if given.remark is not None:
        page += paragraph(name(content.laboratory.spoken(given.remark, words.language)))
    return page


def _condition(given: TemperatureCondition | HumidityCondition) -> str:
    if given.value is not None:
        return f"{given.value:g} {given.unit}, u = {given.u:g} {'K' if given.unit != '%' else '%'}"
    return f"{given.low:g} … {given.high:g} {given.unit}"


def traceability(content: Content, words: Words) -> str:
    """The laboratory's statement and the standards' certificates, or that they are missing."""
    found = content.laboratory
    if found is None:
        return ""
    file, language = found.file, words.language
    page = ""
    if file.equipment:
        rows = [
            [
                name(found.spoken(each.name, language)),
                name(each.serial),
                name(each.certificate or "–"),
                name(each.certified_by or "–"),
            ]
            for each in file.equipment
        ]
        keys = ("standard", "serial", "certificate", "certified-by")
        page += table([words(f"column.{key}") for key in keys], rows, words("section.traceability"), left=4)
    else:
        page += paragraph(words("traceability.no-equipment"), "missing")
    if file.traceability is None:
        return page + paragraph(words("traceability.no-statement"), "missing")
    return page + paragraph(name(found.spoken(file.traceability.statement, language)))
