"""Plots of parameters and lengths on paper: before and after, how far parameters moved, length errors."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.ticker import NullLocator

from ulna.documents.content.acceptance import TestedLengths, limit_lines
from ulna.documents.content.parameters import Parameters
from ulna.documents.content.quality import QualityRow
from ulna.documents.content.readings import Lengths
from ulna.documents.content.thinning import shown
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.pdf.canvas import WIDTH_MM, axes_of, labels, svg_of
from ulna.ground.style import BLUE, GREEN, GREY, OF_VERDICT, ORANGE

MOST_LENGTHS = 1200
LONGEST_LABEL = 30
#: verdict → shape and colour of its marks
VERDICTS = {
    each: (mark, OF_VERDICT[each]) for each, mark in (("pass", "o"), ("undecided", "D"), ("fail", "X"), (None, "o"))
}


def before_after(rows: Sequence[QualityRow], words: Words) -> str:
    """RMS of each quantity before and after, all of them known, on a logarithmic axis."""
    say = labels(words)
    pairs = [(row, row.before.rms_mm, row.after.rms_mm) for row in rows if row.before and row.after]
    figure, axes = axes_of(WIDTH_MM, 16.0 + 9.0 * len(pairs))
    y = np.arange(len(pairs))[::-1]
    before, after = (np.array([pair[k] for pair in pairs], dtype=np.float64) for k in (1, 2))
    axes.hlines(y, after, before, color="0.7", linewidth=1.5)
    axes.plot(before, y, "s", color=GREY, markersize=5, label=say("legend.before"))
    axes.plot(after, y, "o", color=BLUE, markersize=5.5, label=say("legend.after"))
    axes.set_xscale("log")
    low, high = math.log10(min(before.min(), after.min())), math.log10(max(before.max(), after.max()))
    axes.set_xlim(10.0 ** (math.floor(low * 2 - 0.2) / 2), 10.0 ** (math.ceil(high * 2 + 0.2) / 2))
    axes.set_yticks(y, [f"{say(f'quantity.{row.quantity}')}\n{say(f'readings.{row.readings}')}" for row, *_ in pairs])
    axes.set_ylim(-0.6, len(pairs) - 0.4)
    axes.set_xlabel(say("axis.rms-mm"))
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=7)
    return svg_of(figure)


def ratios(parameters: Parameters, words: Words) -> str:
    """(estimate - nominal) / u of each fitted parameter."""
    rows = [(number, row) for number, row in enumerate(parameters.rows, start=1) if row.ratio is not None]
    figure, axes = axes_of(WIDTH_MM, 14.0 + 3.9 * len(rows))
    y = np.arange(len(rows))[::-1]
    value = np.array([row.ratio for _, row in rows], dtype=np.float64)
    axes.axvspan(-2.0, 2.0, color=GREEN, alpha=0.15, linewidth=0)
    axes.hlines(y, 0.0, value, color=BLUE, linewidth=1.0)
    axes.plot(value, y, "o", color=BLUE, markersize=3.5)
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.set_xscale("symlog", linthresh=4.0, linscale=1.0)
    most = 1.6 * max(float(np.abs(value).max()), 4.0)
    axes.set_xlim(-most, most)
    decades = math.floor(math.log10(most))
    powers = range(1, decades + 1, max(math.ceil(decades / 5), 1))
    ticks = [
        (sign * 10.0**power, f"{'−' if sign < 0 else ''}10{_power(power)}") for sign in (-1, 1) for power in powers
    ]
    ticks += [(-2.0, "−2"), (0.0, "0"), (2.0, "2")]
    axes.set_xticks([at for at, _ in ticks], [label for _, label in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_yticks(y, [_label(number, row.name) for number, row in rows], parse_math=False, fontsize=6.5)
    axes.set_ylim(-0.7, len(rows) - 0.3)
    axes.set_xlabel(labels(words)("column.ratio"))
    return svg_of(figure)


def _power(power: int) -> str:
    """As an exponent; of 1 none."""
    return "" if power == 1 else "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(power))


def _label(number: int, name: str) -> str:
    """Number in the table, and the name where it is plain and short enough to be drawn letter by letter."""
    plain = name.isascii() and name.isprintable() and len(name) <= LONGEST_LABEL
    return f"{name}  {number}" if plain else f"{number}"


def lengths(found: Lengths, words: Words) -> tuple[str, list[Text]]:
    """Length errors over lengths; the picture and what its caption must say of what is shown."""
    say = labels(words)
    figure, axes = axes_of(WIDTH_MM, 55.0)
    part = shown(np.zeros(len(found.error_mm), dtype=bool), MOST_LENGTHS)
    length = found.length_mm[part.index]
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.plot(length, found.error_mm[part.index], ".", color=BLUE, markersize=3.5)
    if float(np.ptp(length)) == 0.0:  # one length: an axis that is not made of rounding
        axes.set_xlim(0.9 * float(length[0]), 1.1 * float(length[0]))
    axes.set_xlabel(say("axis.length-mm"))
    axes.set_ylabel(say("axis.length-error-mm"))
    return svg_of(figure), [words.say(part.said)] if part.step > 1 else []


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
    return svg_of(figure)
