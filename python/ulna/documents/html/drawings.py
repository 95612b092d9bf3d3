"""How this page draws each kind of plot: one row each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ulna.documents.content.content import Content
from ulna.documents.html.arm_plot import arm_plot
from ulna.documents.html.parameter_plots import correlation_plot, length_plot, singular_plot
from ulna.documents.html.plots import Plot, Still
from ulna.documents.html.residual_plots import cloud_plot, histogram_plot, quantile_plot
from ulna.documents.html.space_plots import pose_plot, space_plot
from ulna.documents.html.tested_plots import tested_lengths_plot
from ulna.documents.languages.text import joined
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Drawing

#: kind → (drawing, content, words) → plot; its caption is what must be said of what is shown
DRAWN: dict[str, Callable[[Drawing, Content, Words], Plot | Still]] = {
    "arm": lambda each, _, words: arm_plot(each.name, each.of, words),
    "histogram": lambda each, _, words: histogram_plot(each.name, each.of, words),
    "quantiles": lambda each, _, words: quantile_plot(each.name, each.of, words),
    "cloud": lambda each, content, words: cloud_plot(each.name, each.of, content.readings, words),
    "poses": lambda each, _, words: pose_plot(each.name, each.of, words),
    "space": lambda each, content, words: space_plot(each.name, each.of, content.readings, words),
    "correlation": lambda each, _, words: correlation_plot(each.name, each.of, words),
    "singular": lambda each, _, words: singular_plot(each.name, each.of, words),
    "lengths": lambda each, _, words: length_plot(each.name, each.of, words),
    "tested-lengths": lambda each, _, words: tested_lengths_plot(each.name, each.of, words),
}


def draw(drawing: Drawing, content: Content, words: Words) -> Plot | Still:
    """With the whole caption. Errors: KeyError for a kind that this page cannot draw."""
    plot = DRAWN[drawing.kind](drawing, content, words)
    return replace(plot, caption=joined([drawing.caption, plot.caption], " "))
