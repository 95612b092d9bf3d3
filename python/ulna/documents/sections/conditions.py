"""The circumstances: the room, as the laboratory says it, and what the readings say themselves."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.content.environment import Environment
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.tables import HumidityCondition, TemperatureCondition
from ulna.documents.languages.text import Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own
from ulna.ground.digits import small

#: unit of a condition → unit of its standard uncertainty
UNITS_OF_U = {"°C": "K", "K": "K", "%": "%"}


def conditions(content: Content, words: Words) -> list[Block]:
    """The room, then the readings."""
    page: list[Block] = [] if content.laboratory is None else room(content.laboratory, words)
    return page + _readings(content, words)


def room(laboratory: Laboratory, words: Words) -> list[Block]:
    """How warm and damp it was."""
    given = laboratory.file.environment
    said = [words("environment.room-temperature", shown=_condition(given.temperature))]
    if given.humidity is not None:
        said.append(words("environment.room-humidity", shown=_condition(given.humidity)))
    page: list[Block] = [Paragraph(joined(said, " "))]
    if given.remark is not None:
        page.append(Paragraph(named(laboratory.spoken(given.remark, words.language))))
    return page


def _condition(given: TemperatureCondition | HumidityCondition) -> Text:
    """A value with its u, or a range; kept on one line."""
    if given.value is not None:
        shown = f"{given.value:g} {given.unit}, u = {given.u:g} {UNITS_OF_U[given.unit]}"
    else:
        shown = f"{given.low:g} … {given.high:g} {given.unit}"
    return own(shown.replace(" ", "\u00a0"))


def _readings(content: Content, words: Words) -> list[Block]:
    found = content.environment
    page: list[Block] = []
    if found.temperature_c is None:
        page.append(Paragraph(words("environment.no-temperature"), "missing"))
    else:
        low, mean, high = (own(f"{value:.1f}") for value in found.temperature_c)
        page.append(Paragraph(words("environment.temperature", low=low, mean=mean, high=high)))
    stated = noise(found, words)
    page += [Paragraph(each) for each in stated]
    if not stated:
        page.append(Paragraph(words("environment.no-noise"), "missing"))
    if content.laboratory is None or content.laboratory.file.environment.humidity is None:
        page.append(Paragraph(words("environment.else"), "note"))
    return page


def noise(found: Environment, words: Words) -> list[Text]:
    """What is stated of it: of the encoders (once where all are alike), of a touch."""
    said = []
    if found.encoder_rad:
        each = found.encoder_rad[:1] if len(set(found.encoder_rad)) == 1 else found.encoder_rad
        said.append(words("environment.encoder", encoder=own(", ".join(small(value, 2) for value in each))))
    if found.seat_mm is not None:
        said.append(words("environment.seat", seat=own(f"{found.seat_mm:g}")))
    return said
