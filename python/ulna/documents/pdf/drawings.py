"""How paper shows each kind of plot: one row each."""

from __future__ import annotations

from collections.abc import Callable

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.pdf import arm_plot, parameter_plots, plots
from ulna.documents.sections.blocks import Drawing

Drawn = tuple[str, list[Text]]
"""SVG, and what must be said of what is shown."""

#: kind → (drawing, content, words) → plot
DRAWN: dict[str, Callable[[Drawing, Content, Words], Drawn]] = {
    "arm": lambda each, _, words: (arm_plot.arm(each.of), []),
    "histogram": lambda each, _, words: (plots.histogram(each.of, words), []),
    "quantiles": lambda each, _, words: plots.quantiles(each.of, words),
    "cloud": lambda each, content, words: plots.cloud(each.of, content.readings, words),
    "before-after": lambda each, _, words: (parameter_plots.before_after(each.of, words), []),
    "ratios": lambda each, _, words: (parameter_plots.ratios(each.of, words), []),
    "lengths": lambda each, _, words: parameter_plots.lengths(each.of, words),
    "tested-lengths": lambda each, _, words: (parameter_plots.tested_lengths(each.of, words), []),
}


def draw(drawing: Drawing, content: Content, words: Words) -> Drawn:
    """Errors: KeyError for a kind that paper cannot show."""
    return DRAWN[drawing.kind](drawing, content, words)
