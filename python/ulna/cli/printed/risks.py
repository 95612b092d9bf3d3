"""What the decisions of an acceptance test risk, for the terminal: of each figure's worst value, and of all arms."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import table
from ulna.ground.digits import percent
from ulna.verification.outcome import FigureResult
from ulna.verification.risk import Risk
from ulna.verification.verify import Verification

Known = tuple[str, FigureResult, Risk]
"""State, figure, and what its decision risks."""
OF_THE_VALUES = "Of the tested values, by their u alone: how the arm errs in other places is not in it."
NO_PROCESS = (
    "Global risks, of all arms of a kind, need what is made: [process.KEY] in the verify file. Without it the risk of "
    "each decision is all that is known."
)


def risks(found: Verification) -> list[RenderableType]:
    """[] where no figure has both a limit and an uncertainty."""
    known: list[Known] = [
        (state.state, figure, risk)
        for state in found.states
        for figure in state.figures.values()
        if (risk := figure.risk) is not None
    ]
    if not known:
        return []
    both = len({state for state, _, _ in known}) > 1

    def shown(title: str, heads: list[str], cells: Callable[[Risk], list[str]], of: list[Known]) -> RenderableType:
        rows = [[*([state] if both else []), figure.definition.key, *cells(risk)] for state, figure, risk in of]
        return table(title, [*(["state"] if both else []), "", *heads], rows, left=1 + both)

    heads = ["keeps the\nlimit", "verdict\nwrong", "wrong pass\nat most", "wrong fail\nat most"]
    parts: list[RenderableType] = ["", shown("Risk of the decisions (JCGM 106), %", heads, _cells, known)]
    parts.append(Text(OF_THE_VALUES))
    made = [each for each in known if each[2].of_all is not None]
    if not made:
        return [*parts, Text(NO_PROCESS)]
    heads = ["wrongly\npass", "wrongly\nfail", "conform,\nnot passed", "undecided"]
    said = [Text(each) for each in _processes([figure for _, figure, _ in made])]
    return [*parts, "", shown("Of all that are made so, %", heads, _shares, made), *said]


def _cells(risk: Risk) -> list[str]:
    numbers = (risk.conformity, risk.specific, risk.consumer_at_most, risk.producer_at_most)
    return ["–" if each is None else percent(each) for each in numbers]


def _shares(risk: Risk) -> list[str]:
    of_all = risk.of_all
    assert of_all is not None
    return [percent(each) for each in (of_all.consumer, of_all.producer, of_all.withheld, of_all.undecided)]


def _processes(figures: list[FigureResult]) -> list[str]:
    """What is made, once for each figure."""
    said = {}
    for figure in figures:
        if figure.process is not None:
            mean, deviation = 1000.0 * figure.process.mean_mm, 1000.0 * figure.process.deviation_mm
            kind = figure.process.made(figure.definition.signed).distribution
            key = figure.definition.key
            said[key] = (
                f"{key}: as stated, a {kind} distribution of true values, mean {mean:g} µm, standard deviation "
                f"{deviation:g} µm."
            )
    return list(said.values())
