"""Plots of parameters and lengths on paper: before and after, how far parameters moved, length errors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ulna.documents.content.acceptance import TestedLengths, limit_lines
from ulna.documents.content.parameters import Parameters
from ulna.documents.content.quality import QualityRow
from ulna.documents.content.readings import Lengths
from ulna.documents.drawn import parameters as drawn
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.pdf.canvas import WIDTH_MM, axes_of, labels, svg_of
from ulna.ground.style import OF_VERDICT, ORANGE

#: verdict → shape and colour of its marks
VERDICTS = {
    each: (mark, OF_VERDICT[each]) for each, mark in (("pass", "o"), ("undecided", "D"), ("fail", "X"), (None, "o"))
}


def before_after(rows: Sequence[QualityRow], words: Words) -> str:
    """RMS of each quantity before and after, all of them known, on a logarithmic axis."""
    figure, axes = axes_of(WIDTH_MM, 16.0 + 9.0 * len(rows))
    drawn.before_after(axes, rows, labels(words))
    return svg_of(figure, words)


def ratios(parameters: Parameters, words: Words) -> str:
    """(estimate - nominal) / u of each fitted parameter."""
    figure, axes = axes_of(WIDTH_MM, 14.0 + 3.9 * len(drawn.rated(parameters)))
    drawn.ratios(axes, parameters, labels(words))
    return svg_of(figure, words)


def lengths(found: Lengths, words: Words) -> tuple[str, list[Text]]:
    """Length errors over lengths; the picture and what its caption must say of what is shown."""
    figure, axes = axes_of(WIDTH_MM, 55.0)
    part = drawn.lengths(axes, found, labels(words))
    return svg_of(figure, words), [words.say(part.said)] if part.step > 1 else []


def tested_lengths(found: TestedLengths, words: Words) -> str:
    """Length errors of an acceptance test, with ±MPE and the guard bands about them."""
    say = labels(words)
    figure, axes = axes_of(WIDTH_MM, 62.0)
    lines = limit_lines(found)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    if lines is not None:
        x, limit, guard = lines
        for side in (1.0, -1.0):
            first = side > 0.0
            if guard.any():
                label = say("legend.guard") if first else None
                band = (side * (limit - guard), side * (limit + guard))
                axes.fill_between(x, *band, color=ORANGE, alpha=0.22, linewidth=0, label=label)
            axes.plot(x, side * limit, "--", color="black", linewidth=1.0, label=say("legend.mpe") if first else None)
        axes.set_xlim(x[0], x[-1])
    for verdict, (marker, colour) in VERDICTS.items():
        own = np.array([each == verdict for each in found.verdict], dtype=bool)
        if own.any():
            label = say(f"conformity.{verdict or 'none'}")
            axes.plot(found.length_mm[own], found.error_mm[own], marker, color=colour, markersize=3.5, label=label)
    axes.set_xlabel(say("axis.length-mm"))
    axes.set_ylabel(say("axis.length-error-mm"))
    figure.legend(loc="outside upper center", ncols=6, fontsize=7)
    return svg_of(figure, words)
