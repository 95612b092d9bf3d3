"""What the laboratory says of who calibrated what for whom, when, where and how."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import Address, ContactTable, ItemTable, LaboratoryTable, MethodTable
from ulna.documents.languages.text import Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Fact, Facts, own


def facts(content: Content, words: Words) -> Facts:
    """All of it, by keys; without a laboratory file, what is not stated."""
    found = content.laboratory
    if found is None:
        return _unknown(content, words)
    file = found.file
    made = file.certificate
    rows = [
        Fact("identifier", words("laboratory.identifier"), [named(made.identifier)]),
        Fact("laboratory", words("laboratory.laboratory"), contact(found, file.laboratory, words)),
        Fact("item", words("laboratory.item"), [*_item(found, file.item, words), _arm(content, words)]),
        Fact("condition", words("laboratory.condition"), [_condition(found, file.item, words)]),
        Fact("customer", words("laboratory.customer"), contact(found, file.customer, words)),
    ]
    if made.order is not None:
        rows.append(Fact("order", words("laboratory.order"), [named(made.order)]))
    accredited = accreditation(file.laboratory)
    if accredited:
        rows.append(Fact("accreditation", words("laboratory.accreditation"), [accredited]))
    days = {"received": made.received, "begin": made.begin, "end": made.end, "issued": made.issued}
    rows += [
        Fact(key, words(f"laboratory.{key}"), [own(day.isoformat())]) for key, day in days.items() if day is not None
    ]
    rows.append(Fact("location", words("laboratory.location"), [words(f"location.{made.location}")]))
    if made.replaces is not None:
        replaced = made.replaces
        rows.append(Fact("replaces", words(f"replaces.{replaced.change}"), [named(replaced.identifier)]))
    rows += [
        Fact("person", named(found.spoken(person.role, words.language)), [named(person.name)]) for person in file.person
    ]
    return Facts(rows + _methods(found, words) + _remarks(found, words))


def _unknown(content: Content, words: Words) -> Facts:
    stated = words("laboratory.not-stated")
    return Facts(
        [
            Fact("item", words("laboratory.item"), [_arm(content, words)]),
            Fact("calibrated", words("laboratory.calibrated"), [named(content.provenance.time)]),
            Fact("laboratory", words("laboratory.laboratory"), [stated]),
            Fact("customer", words("laboratory.customer"), [stated]),
        ]
    )


def _arm(content: Content, words: Words) -> Text:
    return words("laboratory.arm", arm=content.arm, joints=content.joints)


def contact(found: Laboratory, given: ContactTable, words: Words) -> list[Text]:
    """Name, address, and by what else they are reached, each on its line."""
    lines = [named(found.spoken(given.name, words.language)), _address(given.address)]
    return lines + [named(each) for each in (given.email, given.phone, given.web) if each is not None]


def _address(address: Address) -> Text:
    street = [] if address.street is None else [named(address.street)]
    place = named(*(each for each in (address.postcode, address.city) if each is not None))
    country = [named(each) for each in (address.state, address.country) if each is not None]
    return joined([*street, place, *country], ", ")


def accreditation(laboratory: LaboratoryTable) -> Text:
    """Body, number and standard; nothing where there is none."""
    given = laboratory.accreditation
    if given is None:
        return ()
    return joined([named(each) for each in (given.body, given.number, given.standard) if each], ", ")


def _item(found: Laboratory, item: ItemTable, words: Words) -> list[Text]:
    lines = [
        named(found.spoken(item.name, words.language)),
        named(item.manufacturer, item.model),
        joined([words("laboratory.serial"), named(item.serial)], " "),
    ]
    if item.description is not None:
        lines.append(named(found.spoken(item.description, words.language)))
    for each in item.identifications:
        label = [] if each.name is None else [named(found.spoken(each.name, words.language))]
        lines.append(joined([*label, named(each.value)], ": "))
    return lines


def _condition(found: Laboratory, item: ItemTable, words: Words) -> Text:
    """On receipt; it is no small thing where nobody looked."""
    if item.condition is None:
        return words("laboratory.not-stated")
    return named(found.spoken(item.condition, words.language))


def _methods(found: Laboratory, words: Words) -> list[Fact]:
    what = words("laboratory.method")
    if not found.file.method:
        return [Fact("method", what, [words("laboratory.not-stated")])]
    return [Fact("method", what, _method(found, method, words)) for method in found.file.method]


def _method(found: Laboratory, method: MethodTable, words: Words) -> list[Text]:
    lines = [named(found.spoken(method.name, words.language))]
    if method.description is not None:
        lines.append(named(found.spoken(method.description, words.language)))
    more = joined([named(each) for each in (*method.norms, *method.references)], ", ")
    return [*lines, more] if more else lines


def _remarks(found: Laboratory, words: Words) -> list[Fact]:
    what = words("laboratory.remark")
    return [Fact("remark", what, [named(found.spoken(each, words.language))]) for each in found.file.remarks]
