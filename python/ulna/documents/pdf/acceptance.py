"""The acceptance test on paper: figures with limits, uncertainties and verdicts, the decision rule, length errors."""

from __future__ import annotations

from ulna.documents.acceptance import wholes
from ulna.documents.content import Content, Verification
from ulna.documents.languages.words import Words
from ulna.documents.pdf import blocks
from ulna.documents.pdf import plots as figures
from ulna.documents.pdf.blocks import Block, Cell
from ulna.documents.pdf.text import name
from ulna.ground.digits import figure_mm, rounded, uncertainty
from ulna.verification.result_file import FigureTable


def verification(content: Content, words: Words) -> list[Block]:
    """Figures with their verdicts, formulas, and where it departs from its profile; or that there is no test."""
    found = content.verification
    page = [blocks.heading(words("section.verification"))]
    if found is None:
        return [*page, blocks.paragraph(words.say(content.missing["verification"]), "missing")]
    file = found.file
    page.append(blocks.paragraph(name(file.profile.statement)))
    page += [blocks.paragraph(words.say(each), "missing") for each in found.remarks]
    rows: list[list[Cell]] = []
    for state in file.states:
        for test in state.tests:
            for figure in test.figures:
                what = f"{name(figure.name)} {name(test.name)}"
                rows.append([words(f"state.{state.state}"), what, *_values(figure, words)])
    keys = ("condition", "figure", "verdict", "value-mm", "expanded-mm", "limit-mm", "guard-mm", "values")
    heads = [words(f"column.{key}") for key in keys]
    page.append(blocks.table(heads, rows, [1, 2.6, 1.5, 1, 1, 1, 1, 0.9], left=3))
    note = words("verification.note", k=f"{file.decision.k:g}", p=f"{100 * file.decision.p:g}")
    page.append(blocks.paragraph(note, "note"))
    for state in file.states:
        said = [*state.departures, *(f"{test.name}: {each}" for test in state.tests for each in test.departures)]
        if said:
            title = words("verification.departures", state=words(f"state.{state.state}"))
            page += [blocks.paragraph(title, "missing"), blocks.listed([name(each) for each in said])]
    return page + _formulas(found, words) + _lengths(found, words)


def _values(figure: FigureTable, words: Words) -> list[Cell]:
    verdict = words(f"conformity.{figure.verdict or 'none'}")
    why = "" if figure.why is None else f" ({name(figure.why)})"
    value, expanded = rounded(figure.value, figure.expanded, "mm")
    limit = "–" if figure.limit is None else figure_mm(figure.limit)
    return [verdict + why, value, expanded, limit, uncertainty(figure.guard), str(len(figure.individual))]


def _formulas(found: Verification, words: Words) -> list[Block]:
    """Each figure's formula, and what no uncertainty of a test value holds."""
    all_figures = [figure for state in found.file.states for test in state.tests for figure in test.figures]
    formulas = {figure.name: figure.formula for figure in all_figures}
    page = [
        blocks.heading(words("verification.formulas"), 2),
        blocks.facts([(name(key), [blocks.english(name(formula))]) for key, formula in formulas.items()]),
    ]
    left_out = dict.fromkeys(each for figure in all_figures for each in figure.left_out)
    if left_out:
        page += [blocks.paragraph(words("verification.left-out")), blocks.listed([name(each) for each in left_out])]
    return page


def _lengths(found: Verification, words: Words) -> list[Block]:
    drawn = []
    for each in found.lengths:
        if len(each.error_mm):
            values = {"figure": each.figure, "test": each.test, "count": len(each.error_mm)}
            caption: str = words("verification.lengths", **values, state=words(f"state.{each.state}"))
            if each.a_mm is None:
                caption = f"{caption} {words('verification.no-mpe')}"
            drawn.append(blocks.figure(figures.tested_lengths(each, words), caption))
    return [blocks.figures(drawn, 1)] if drawn else []


def decision(content: Content, words: Words) -> list[Block]:
    """The rule and what it says on the whole, or that nothing is said."""
    page = [blocks.heading(words("section.decision"))]
    found = content.verification
    if found is None:
        return [*page, blocks.paragraph(words("decision.none"))]
    chosen = found.file.decision
    page.append(blocks.paragraph(words(f"rule.{chosen.rule}", k=f"{chosen.k:g}")))
    styles: dict[str | None, str] = {"pass": "plain", "fail": "bad", "undecided": "missing", None: "missing"}
    for whole in wholes(found.file):
        verdict = words(f"conformity.{whole.verdict or 'none'}")
        said = words("decision.whole", verdict=verdict, state=words(f"state.{whole.state}"))
        page.append(blocks.paragraph(said, styles[whole.verdict]))
        if whole.unmeasured or whole.silent:
            partial = words("decision.partial", unmeasured=whole.unmeasured, silent=whole.silent)
            page.append(blocks.paragraph(partial, "missing"))
    return page
