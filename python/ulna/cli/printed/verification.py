"""What an acceptance test found, for the terminal."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.risks import risks
from ulna.cli.printed.tables import heading, listed, table
from ulna.ground.digits import fixed, uncertainty
from ulna.verification.not_covered import not_covered
from ulna.verification.outcome import FigureResult, StateResult
from ulna.verification.verify import Verification

WORDS = {"pass": "pass", "fail": "FAIL", "undecided": "undecided", None: "–"}
SHORT = {"calibration": "calibr.", "temperature": "temp.", "expansion": "expans.", "form of the ball": "form"}
MOST_LISTED = 8
"""Single values that are shown where they do not pass."""


def verification_report(found: Verification) -> list[RenderableType]:
    """Figures before and after side by side, what departs from the profile, how it was decided."""
    profile = found.plan.profile.file
    parts: list[RenderableType] = [Text(f"Arm: {found.arm}"), Text(profile.statement), Text(found.rule.text), ""]
    names = list(dict.fromkeys(name for state in found.states for name in state.figures))
    states = [state.state for state in found.states]
    rows = [_row(name, found.states) for name in names]
    heads = ["", *(head for state in states for head in (f"{state}\nµm", "limit\nµm", "verdict")), "u\nµm"]
    parts.append(table("Figures, the worst value of each", heads, rows, left=1))
    parts += _not_passed(found)
    parts += risks(found)
    formulas = {figure.definition.name: figure for state in found.states for figure in state.figures.values()}
    parts += [
        "",
        heading("Formulas"),
        listed((_formula(figure),) for figure in formulas.values()),
    ]
    if any(figure.worst.single.budget.contributors for figure in formulas.values()):
        parts += ["", _budgets(list(formulas.values()))]
    departures = [(f"{state.state}: {text}",) for state in found.states for text in _departures(state)]
    if departures:
        parts += ["", heading("Other than the profile counts"), listed(departures)]
    whys = _whys(list(formulas.values()))
    if whys:
        parts += ["", heading("Without a verdict"), listed((text,) for text in whys)]
    left_out = list(dict.fromkeys(text for figure in formulas.values() for text in figure.worst.single.budget.left_out))
    if left_out:
        parts += ["", heading("Not in the uncertainties"), listed((text,) for text in left_out)]
    parts += ["", Text(not_covered(found.plan.file.scanner))]
    verdicts = ", ".join(f"{state.state} {_whole(state)}" for state in found.states)
    return [*parts, "", Text(f"On the whole: {verdicts}.", style="bold")]


def _row(name: str, states: list[StateResult]) -> list[str]:
    figures = [state.figures.get(name) for state in states]
    last = [figure for figure in figures if figure is not None][-1]
    cells = [last.definition.key]
    for figure in figures:
        if figure is None:
            cells += ["–", "–", "–"]
            continue
        limit = figure.worst.limit_mm
        cells += [_um(figure.worst.single.value_mm), "–" if limit is None else _um(limit), WORDS[figure.verdict]]
    u_mm = last.worst.single.budget.u_mm
    return [*cells, _u(u_mm)]


def _u(u_mm: float | None) -> str:
    return "–" if u_mm is None else uncertainty(1000.0 * u_mm)


def _budgets(figures: list[FigureResult]) -> RenderableType:
    """Who contributes to the uncertainty of the worst value of each figure."""
    known = [figure for figure in figures if figure.worst.single.budget.contributors]
    sources = dict.fromkeys(each.name for figure in known for each in figure.worst.single.budget.contributors)
    rows = []
    for figure in known:
        budget = figure.worst.single.budget
        own = {each.name: each.u_mm for each in budget.contributors}
        rows.append([figure.definition.key, *(_u(own.get(source)) for source in sources), _u(budget.u_mm)])
    return table(
        "Uncertainty of the test values: u / µm", ["", *(SHORT.get(each, each) for each in sources), "all"], rows
    )


def _formula(figure: FigureResult) -> str:
    definition = figure.definition
    return f"{definition.key}, {definition.name}: {definition.formula}"


def _um(value_mm: float) -> str:
    return fixed(1000.0 * value_mm, 1)


def _not_passed(found: Verification) -> list[RenderableType]:
    """The single values that fail or are undecided."""
    rows = []
    for state in found.states:
        for figure in state.figures.values():
            for judged in figure.values:
                if judged.decided.verdict in ("fail", "undecided") and judged.limit_mm is not None:
                    labels = " / ".join(judged.single.labels.as_dict().values())
                    size = [_um(judged.single.value_mm), _um(judged.limit_mm)]
                    word = WORDS[judged.decided.verdict]
                    rows.append([state.state, figure.definition.key, labels, *size, word])
    if not rows:
        return []
    heads = ("state", "figure", "artefact / position / repeat", "value\nµm", "limit\nµm", "")
    shown: list[RenderableType] = ["", table("Values that do not pass", heads, rows[:MOST_LISTED], left=3)]
    if len(rows) > MOST_LISTED:
        shown.append(Text(f"… and {len(rows) - MOST_LISTED} more: -o writes all into values.csv."))
    return shown


def _whole(state: StateResult) -> str:
    """The verdict of a state, and of how many figures and tests nothing is said."""
    silent = sum(figure.verdict is None for figure in state.figures.values())
    if state.verdict is None:
        return "without a verdict"
    nothing_said = [
        *([f"{silent} of {len(state.figures)} figures without a verdict"] if silent else []),
        *([f"{len(state.departures)} of the profile's tests not measured"] if state.departures else []),
    ]
    return WORDS[state.verdict] + (f" ({'; '.join(nothing_said)})" if nothing_said else "")


def _departures(state: StateResult) -> list[str]:
    return [*(f"{test.name}: {text}" for test in state.tests for text in test.departures), *state.departures]


def _whys(figures: list[FigureResult]) -> list[str]:
    found: dict[str, list[str]] = {}
    for figure in figures:
        why = figure.worst.decided.why
        if why is not None:
            found.setdefault(why, []).append(figure.definition.key)
    return [f"{why}: {', '.join(keys)}" for why, keys in found.items()]
