"""The acceptance test: figures with limits, uncertainties and verdicts, formulas, every single value."""

from __future__ import annotations

from collections.abc import Iterator

from ulna.documents.content.acceptance import Verification
from ulna.documents.languages.text import NONE, Text, joined, named, styled
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Fact, Facts, Heading, Listed, Paragraph, own, table
from ulna.documents.sections.decision import STYLES, verdict
from ulna.documents.sections.departures import departure
from ulna.documents.sections.risk import share
from ulna.documents.sections.verbatim import formula, left_out, manner
from ulna.ground.digits import figure_mm, fixed, plain_uncertainty, rounded, uncertainty
from ulna.verification.lifted import Lifted
from ulna.verification.result_file import FigureTable, StateTable, TestedTable, ValueTable

COLUMNS = ("condition", "figure", "verdict", "value-mm", "u-mm", "expanded-mm", "limit-mm", "guard-mm", "values")
SINGLES = ("condition", "figure", "where", "verdict", "calibrated-mm", "value-mm", "limit-mm", "u-mm", "conformity")


def verification(found: Verification, words: Words) -> list[Block]:
    """What profile, figures with their verdicts, and where the test departs from its profile."""
    file = found.file
    page: list[Block] = [Paragraph(manner(file.profile, words))]
    page += [Paragraph(words.say(each), "missing") for each in found.remarks]
    rows = [_figure(state, test, figure, words) for state, test, figure in _figures(found)]
    note = words("verification.note", k=own(f"{file.decision.k:g}"), p=own(f"{100 * file.decision.p:g}"))
    page += [
        table("verification", words("section.verification"), words, COLUMNS, rows, left=3),
        Paragraph(note, "note"),
        *_lifted(found, words),
        Paragraph(not_covered(found.scanner, words), "note" if found.scanner is None else "missing"),
    ]
    for state in file.states:
        said = [departure(each, words) for each in state.departures]
        said += [(*named(test.name), ": ", *departure(each, words)) for test in state.tests for each in test.departures]
        if said:
            title = words("verification.departures", state=words(f"state.{state.state}"))
            page += [Paragraph(title, "missing"), Listed(said)]
    return page


def not_covered(scanner: str | None, words: Words) -> Text:
    """What tests with a touching probe say nothing of."""
    return words("verification.tactile") if scanner is None else words("verification.scanner", scanner=scanner)


def lifted(each: Lifted, words: Words) -> Text:
    """Which U was too small for the laboratory to state."""
    state = words(f"state.{each.state}")
    said = words("verification.lifted", figure=each.figure, state=state, values=each.values)
    if each.computed_mm is None:
        return said
    sizes = {"computed": own(uncertainty(each.computed_mm)), "stated": own(uncertainty(each.stated_mm))}
    return joined([said, words("verification.lifted-worst", **sizes)], " ")


def _lifted(found: Verification, words: Words) -> list[Block]:
    page: list[Block] = [Paragraph(lifted(each, words), "missing") for each in found.lifted]
    if found.without:
        page.append(Paragraph(words("verification.no-cmc", figures=", ".join(found.without)), "missing"))
    return page


def formulas(found: Verification, words: Words) -> list[Block]:
    """Each figure's formula, and what no uncertainty of a test value holds."""
    figures = [figure for *_, figure in _figures(found)]
    by_name = {figure.name: formula(figure, words) for figure in figures}
    facts = [Fact(key, named(key), [each]) for key, each in by_name.items()]
    page: list[Block] = [Heading(words("verification.formulas")), Facts(facts)]
    without = list(dict.fromkeys(each for figure in figures for each in figure.left_out))
    if without:
        page += [Paragraph(words("verification.left-out")), Listed([left_out(each, words) for each in without])]
    return page


def singles(found: Verification, words: Words, most: int) -> list[Block]:
    """The first `most` single values, and how many more there are."""
    # to the place of U, as the worst values are: a table of singles may not tell more than a certificate does
    rows = [_single(state, figure, each, words) for state, _, figure in _figures(found) for each in figure.individual]
    title = words("verification.singles", count=len(rows))
    page: list[Block] = [Heading(title), table("singles", title, words, SINGLES, rows[:most], left=4)]
    more = len(rows) - most
    if more > 0:
        page.append(Paragraph(words("verification.more", more=more, shown=most), "missing"))
    return page


def _figures(found: Verification) -> Iterator[tuple[StateTable, TestedTable, FigureTable]]:
    for state in found.file.states:
        for test in state.tests:
            for figure in test.figures:
                yield state, test, figure


def _figure(state: StateTable, test: TestedTable, figure: FigureTable, words: Words) -> list[Text]:
    said = styled(verdict(figure.verdict, words), STYLES[figure.verdict])
    if figure.why is not None:
        why = ("(", *styled(named(figure.why), "english"), ")")
        said = joined([said, styled(why, "aside")], " ")
    value, expanded = rounded(figure.value, figure.expanded, "mm")
    limit = "–" if figure.limit is None else fixed(figure.limit, max(len(value.partition(".")[2]), 4))
    numbers = [value, uncertainty(figure.u), expanded, limit, plain_uncertainty(figure.guard, "mm")]
    return [
        words(f"state.{state.state}"),
        joined([named(figure.name), styled(named(test.name), "aside")], " "),
        said,
        *(own(each) for each in numbers),
        own(len(figure.individual)),
    ]


def _single(state: StateTable, figure: FigureTable, each: ValueTable, words: Words) -> list[Text]:
    value, _ = rounded(each.value, None if each.u is None else figure.k * each.u, "mm")
    where = " / ".join(label for label in (each.artefact, each.position, each.orientation, each.repeat) if label)
    return [
        words(f"state.{state.state}"),
        named(figure.key),
        named(where),
        verdict(each.verdict, words),
        NONE if each.calibrated is None else own(f"{each.calibrated:.4f}"),
        *(own(shown) for shown in (value, _mm(each.limit), uncertainty(each.u))),
        share(each.conformity),
    ]


def _mm(value: float | None) -> str:
    return "–" if value is None else figure_mm(value)
