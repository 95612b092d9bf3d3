"""The acceptance test: figures with limits, uncertainties and verdicts, every single value, the decision rule."""

from __future__ import annotations

import numpy as np

from ulna.documents.acceptance import limit_lines, wholes
from ulna.documents.content import Content, TestedLengths, Verification
from ulna.documents.html.markup import name, paragraph, table, text
from ulna.documents.html.plots import INK, MAIN, OUTLIER, SECOND, Plot, axis, layout, line, points
from ulna.documents.languages.words import Words
from ulna.ground.digits import figure_mm, uncertainty
from ulna.verification.result_file import FigureTable, TestedTable

MOST_SINGLES = 1000
#: verdict → colour and shape of its marks
MARKS = {"pass": (MAIN, "circle"), "undecided": (SECOND, "diamond"), "fail": (OUTLIER, "x"), None: (INK, "circle-open")}


def verification(content: Content, words: Words) -> str:
    """Figures with their verdicts, and departures; nothing where there is no test."""
    found = content.verification
    if found is None:
        return ""
    file = found.file
    page = paragraph(f'<span lang="en">{name(file.profile.statement)}</span>')
    page += "".join(paragraph(words.say(each), "missing") for each in found.remarks)
    rows = []
    for state in file.states:
        for test in state.tests:
            for figure in test.figures:
                rows.append(_figure(state.state, test, figure, words))
    keys = ("condition", "figure", "verdict", "value-mm", "limit-mm", "u-mm", "expanded-mm", "guard-mm", "values")
    label = words("section.verification")
    page += table([words(f"column.{key}") for key in keys], rows, label, left=3)
    page += paragraph(words("verification.note", k=f"{file.decision.k:g}", p=f"{100 * file.decision.p:g}"), "note")
    for state in file.states:
        said = [*state.departures, *(f"{test.name}: {each}" for test in state.tests for each in test.departures)]
        if said:
            listed = "".join(f'<li lang="en">{name(each)}</li>\n' for each in said)
            title = words("verification.departures", state=words(f"state.{state.state}"))
            page += f"{paragraph(title, 'missing')}<ul>\n{listed}</ul>\n"
    return page


def details(content: Content, words: Words) -> str:
    """Formulas, what the uncertainties leave out, every single value."""
    found = content.verification
    if found is None:
        return ""
    figures = [figure for state in found.file.states for test in state.tests for figure in test.figures]
    formulas = {figure.name: figure.formula for figure in figures}
    listed = "".join(f'<dt>{name(key)}</dt><dd lang="en">{name(formula)}</dd>\n' for key, formula in formulas.items())
    page = f"<h3>{words('verification.formulas')}</h3>\n<dl>{listed}</dl>\n"
    return page + _left_out(found, words) + _singles(found, words)


def _figure(state: str, test: TestedTable, figure: FigureTable, words: Words) -> list[str]:
    def mm(value: float | None) -> str:
        return "–" if value is None else text(figure_mm(value))

    why = "" if figure.why is None else f' <small lang="en">{name(figure.why)}</small>'
    verdict = words(f"conformity.{figure.verdict or 'none'}") + why
    return [
        words(f"state.{state}"),
        f"{name(figure.name)} <small>{name(test.name)}</small>",
        f'<b class="verdict {figure.verdict or ""}">{verdict}</b>',
        mm(figure.value),
        mm(figure.limit),
        text(uncertainty(figure.u)),
        text(uncertainty(figure.expanded)),
        text(uncertainty(figure.guard)),
        str(len(figure.individual)),
    ]


def _left_out(found: Verification, words: Words) -> str:
    """What no uncertainty of a test value holds."""
    figures = [figure for state in found.file.states for test in state.tests for figure in test.figures]
    said = dict.fromkeys(each for figure in figures for each in figure.left_out)
    if not said:
        return ""
    listed = "".join(f'<li lang="en">{name(each)}</li>\n' for each in said)
    return f"{paragraph(words('verification.left-out'))}<ul>\n{listed}</ul>\n"


def _singles(found: Verification, words: Words) -> str:
    rows = []
    for state in found.file.states:
        for test in state.tests:
            for figure in test.figures:
                for each in figure.individual:
                    where = [each.artefact, each.position, each.orientation, each.repeat]
                    rows.append(
                        [
                            words(f"state.{state.state}"),
                            name(figure.key),
                            name(" / ".join(label for label in where if label)),
                            words(f"conformity.{each.verdict or 'none'}"),
                            "–" if each.calibrated is None else text(f"{each.calibrated:.4f}"),
                            text(figure_mm(each.value)),
                            "–" if each.limit is None else text(figure_mm(each.limit)),
                            text(uncertainty(each.u)),
                        ]
                    )
    keys = ("condition", "figure", "where", "verdict", "calibrated-mm", "value-mm", "limit-mm", "u-mm")
    title = words("verification.singles", count=len(rows))
    heads = [words(f"column.{key}") for key in keys]
    page = f"<h3>{title}</h3>\n{table(heads, rows[:MOST_SINGLES], title, left=4, tall=True)}"
    more = len(rows) - MOST_SINGLES
    return page + (paragraph(words("verification.more", more=more, shown=MOST_SINGLES), "missing") if more > 0 else "")


def decision(content: Content, words: Words) -> str:
    """The rule and what it says on the whole, or that nothing is said."""
    found = content.verification
    if found is None:
        return paragraph(words("decision.none"))
    file = found.file
    page = paragraph(words(f"rule.{file.decision.rule}", k=f"{file.decision.k:g}"))
    kinds = {"pass": "ending", "fail": "ending bad", "undecided": "missing", None: "missing"}
    for whole in wholes(file):
        verdict = words(f"conformity.{whole.verdict or 'none'}")
        said = words("decision.whole", verdict=verdict, state=words(f"state.{whole.state}"))
        page += paragraph(said, kinds[whole.verdict])
        if whole.unmeasured or whole.silent:
            page += paragraph(words("decision.partial", unmeasured=whole.unmeasured, silent=whole.silent), "missing")
    return page


def tested_lengths_plot(number: int, found: TestedLengths, page: Words, words: Words) -> Plot:
    """Length errors of a test over the length, with ±MPE and the guard bands about them."""
    data = _limits(found, words)
    for verdict, (colour, symbol) in MARKS.items():
        own = np.array([each == verdict for each in found.verdict], dtype=bool)
        if own.any():
            label = words(f"conformity.{verdict or 'none'}")
            data.append(points(label, found.length_mm[own], found.error_mm[own], colour, symbol, 7))
    caption: str = page(
        "verification.lengths",
        figure=found.figure,
        test=found.test,
        state=page(f"state.{found.state}"),
        count=len(found.error_mm),
    )
    if found.a_mm is None:
        caption += f" {page('verification.no-mpe')}"
    shape = layout(axis(words("axis.length-mm"), zeroline=False), axis(words("axis.length-error-mm")), True)
    return Plot(f"tested-{number}", caption, data, shape, 380)


def _limits(found: TestedLengths, words: Words) -> list[dict[str, object]]:
    lines = limit_lines(found)
    if lines is None:
        return []
    x, limit, guard = lines
    data: list[dict[str, object]] = []
    for side in (1.0, -1.0):
        shown = {"showlegend": side > 0.0}
        if guard.any():
            outline = np.concatenate([limit + guard, (limit - guard)[::-1]])
            band = line(words("legend.guard"), np.concatenate([x, x[::-1]]), side * outline, "@band", "solid", **shown)
            data.append({**band, "fill": "toself", "fillcolor": "@band", "hoverinfo": "skip"})
        data.append(line(words("legend.mpe"), x, side * limit, INK, "dash", **shown))
    return data
