"""What the decisions of an acceptance test risk: of each figure's worst value, of the rule, of all that are made."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.documents.languages.text import NONE, Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Heading, Listed, Paragraph, own, table
from ulna.ground.digits import figure_mm, percent
from ulna.verification.result_file import FigureTable, GlobalRiskTable, ProcessTable, RiskTable, VerificationFile

COLUMNS = ("condition", "figure", "conformity", "specific", "consumer-at-most", "producer-at-most")
GLOBAL = ("condition", "figure", "consumer", "producer", "withheld", "undecided")


def risks(file: VerificationFile, words: Words) -> list[Block]:
    """[] where no figure has both a limit and an uncertainty, and of files that were written before risks were."""
    known = list(_known(file))
    if not known:
        return []
    title = words("risk.title")
    rows = [[*_of(state, figure, words), *map(share, _specific(risk))] for state, figure, risk in known]
    page: list[Block] = [Heading(title), table("risk", title, words, COLUMNS, rows, left=2)]
    page.append(Paragraph(words("risk.note"), "note"))
    made = [(state, figure, risk.of_all) for state, figure, risk in known if risk.of_all is not None]
    if not made:
        return [*page, Paragraph(words("risk.no-process"), "missing")]
    title = words("risk.global-title")
    rows = [[*_of(state, figure, words), *map(share, _global(of_all))] for state, figure, of_all in made]
    note = Paragraph(words("risk.global-note"), "note")
    processes = {figure.key: of_all.process for _, figure, of_all in made}
    said = [joined([named(key), process(of, words)], ": ") for key, of in processes.items()]
    return [*page, Heading(title), table("global-risk", title, words, GLOBAL, rows, left=2), note, Listed(said)]


def share(probability: float | None) -> Text:
    """In percent."""
    return NONE if probability is None else own(percent(probability))


def process(made: ProcessTable, words: Words) -> Text:
    """What is made, in words."""
    numbers = {"mean": own(figure_mm(made.mean)), "deviation": own(figure_mm(made.deviation))}
    return words("risk.process", distribution=words(f"risk.{made.distribution}"), **numbers)


def _known(file: VerificationFile) -> Iterator[tuple[str, FigureTable, RiskTable]]:
    for state in file.states:
        for test in state.tests:
            for figure in test.figures:
                if figure.risk is not None:
                    yield state.state, figure, figure.risk


def _of(state: str, figure: FigureTable, words: Words) -> list[Text]:
    return [words(f"state.{state}"), named(figure.key)]


def _specific(risk: RiskTable) -> tuple[float | None, ...]:
    return risk.conformity, risk.specific, risk.consumer_at_most, risk.producer_at_most


def _global(of_all: GlobalRiskTable) -> tuple[float, ...]:
    return of_all.consumer, of_all.producer, of_all.withheld, of_all.undecided
