"""Drawings of parameters and lengths on axes of Matplotlib: before and after, how far parameters moved, length errors.

Paper and notebooks draw the same, as `documents/drawn/residuals.py` says.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import NullLocator

from ulna.documents.content.parameters import ParameterRow, Parameters
from ulna.documents.content.quality import QualityRow
from ulna.documents.content.readings import Lengths
from ulna.documents.content.thinning import Shown, shown
from ulna.documents.drawn.residuals import Say
from ulna.ground.style import BLUE, GREEN, GREY

MOST_LENGTHS = 1200
LONGEST_LABEL = 30


def before_after(axes: Axes, rows: Sequence[QualityRow], say: Say) -> None:
    """RMS of each quantity before and after, all of them known, on a logarithmic axis."""
    pairs = [(row, row.before.rms_mm, row.after.rms_mm) for row in rows if row.before and row.after]
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


def rated(parameters: Parameters) -> list[tuple[int, ParameterRow]]:
    """The parameters whose uncertainty is known, with their numbers."""
    return [(number, row) for number, row in enumerate(parameters.rows, start=1) if row.ratio is not None]


def ratios(axes: Axes, parameters: Parameters, say: Say, small: float = 6.5) -> None:
    """(estimate - nominal) / u of each fitted parameter. small: size of their names' letters."""
    rows = rated(parameters)
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
    axes.set_yticks(y, [_label(number, row.name) for number, row in rows], parse_math=False, fontsize=small)
    axes.set_ylim(-0.7, len(rows) - 0.3)
    axes.set_xlabel(say("column.ratio"))


def _power(power: int) -> str:
    """As an exponent; of 1 none."""
    return "" if power == 1 else "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(power))


def _label(number: int, name: str) -> str:
    """Number in the table, and the name where it is plain and short enough to be drawn letter by letter."""
    plain = name.isascii() and name.isprintable() and len(name) <= LONGEST_LABEL
    return f"{name}  {number}" if plain else f"{number}"


def lengths(axes: Axes, found: Lengths, say: Say) -> Shown:
    """Length errors over lengths; what is shown of them."""
    part = shown(np.zeros(len(found.error_mm), dtype=bool), MOST_LENGTHS)
    length = found.length_mm[part.index]
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.plot(length, found.error_mm[part.index], ".", color=BLUE, markersize=3.5)
    if float(np.ptp(length)) == 0.0:  # one length: an axis that is not made of rounding
        axes.set_xlim(0.9 * float(length[0]), 1.1 * float(length[0]))
    axes.set_xlabel(say("axis.length-mm"))
    axes.set_ylabel(say("axis.length-error-mm"))
    return part
