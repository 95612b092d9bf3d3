"""What an acceptance test found, for the terminal."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.report.digits import fixed, uncertainty
from ulna.report.tables import heading, listed, table
from ulna.verification.outcome import FigureResult, StateResult
from ulna.verification.verify import Verification

WORDS = {"pass": "pass", "fail": "FAIL", "undecided": "undecided", None: "–"}
MOST_LISTED = 8
"""Single values that are shown where they do not pass."""


def verification_report(found: Verification) -> list[RenderableType]:
    """Figures before and after side by side, what departs from the profile, how it was decided."""
    profile = found.plan.profile.file
    parts: list[RenderableType] = [Text(f"Arm: {found.arm}"), Text(profile.statement), Text(found.rule.text), ""]
    names = list(dict.fromkeys(name for state in found.states for name in state.figures))
    states = [state.state for state in found.states]
    rows = [_row(name, found.states) for name in names]
    heads = ["", *(head for state in states for head in (f"{state}\nµm", "verdict")), "limit\nµm", "u\nµm"]
    parts.append(table("Figures, the worst value of each", heads, rows, left=1))
    parts += _not_passed(found)
    formulas = {figure.definition.name: figure for state in found.states for figure in state.figures.values()}
    parts += [
        "",
        heading("Formulas"),
        listed((f"{name}: {figure.definition.formula}",) for name, figure in formulas.items()),
    ]
    departures = [(f"{state.state}: {text}",) for state in found.states for text in _departures(state)]
    if departures:
        parts += ["", heading("Other than the profile counts"), listed(departures)]
    whys = _whys(list(formulas.values()))
    if whys:
        parts += ["", heading("Without a verdict"), listed((text,) for text in whys)]
    left_out = list(dict.fromkeys(text for figure in formulas.values() for text in figure.worst.single.budget.left_out))
    if left_out:
        parts += ["", heading("Not in the uncertainties"), listed((text,) for text in left_out)]
    verdicts = ", ".join(f"{state.state}: {WORDS[state.verdict]}" for state in found.states)
    return [*parts, "", Text(f"On the whole: {verdicts}.", style="bold")]


def _row(name: str, states: list[StateResult]) -> list[str]:
    cells = [name]
    last: FigureResult | None = None
    for state in states:
        figure = state.figures.get(name)
        last = figure or last
        cells += ["–", "–"] if figure is None else [_um(figure.worst.single.value_mm), WORDS[figure.verdict]]
    assert last is not None
    u_mm = last.worst.single.budget.u_mm
    limit = last.worst.limit_mm
    return [*cells, "–" if limit is None else _um(limit), "–" if u_mm is None else uncertainty(1000.0 * u_mm)]


def _um(value_mm: float) -> str:
    return fixed(1000.0 * value_mm, 1)


def _not_passed(found: Verification) -> list[RenderableType]:
    """The single values that fail or are undecided."""
    rows = []
    for state in found.states:
        for figure in state.figures.values():
            for judged in figure.values:
                if judged.decided.verdict in ("fail", "undecided") and judged.limit_mm is not None:
                    labels = ", ".join(f"{key} {label}" for key, label in judged.single.labels.as_dict().items())
                    size = [_um(judged.single.value_mm), _um(judged.limit_mm)]
                    word = WORDS[judged.decided.verdict]
                    rows.append([state.state, figure.definition.key, labels, *size, word])
    if not rows:
        return []
    heads = ("state", "figure", "of", "value\nµm", "limit\nµm", "")
    shown: list[RenderableType] = ["", table("Values that do not pass", heads, rows[:MOST_LISTED], left=3)]
    if len(rows) > MOST_LISTED:
        shown.append(Text(f"… and {len(rows) - MOST_LISTED} more: -o writes all into values.csv."))
    return shown


def _departures(state: StateResult) -> list[str]:
    return [*(f"{test.name}: {text}" for test in state.tests for text in test.departures), *state.departures]


def _whys(figures: list[FigureResult]) -> list[str]:
    found: dict[str, list[str]] = {}
    for figure in figures:
        why = figure.worst.decided.why
        if why is not None:
            found.setdefault(why, []).append(figure.definition.key)
    return [f"{why}: {', '.join(keys)}" for why, keys in found.items()]
